#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "scenes/catalogue.h"
#include "scenes/loader.h"
#include "tests/scenes/closed_surface.h"

namespace regather::scenes {
namespace {

TEST(Embedded, EveryRowLoadsUnderItsOwnName) {
    ASSERT_EQ(catalogue().size(), 10u);
    for (const EmbeddedScene& entry : catalogue()) {
        const Scene scene = load_scene(entry.name);
        EXPECT_EQ(scene.name, entry.name);
        EXPECT_EQ(entry.summary.find('\n'), std::string_view::npos);
        EXPECT_EQ(scene.triangle_material.size(), scene.triangles.size());
        EXPECT_EQ(scene.triangle_light.size(), scene.triangles.size());
        EXPECT_EQ(scene.normals.size(), scene.vertices.size());
        for (const auto& triangle : scene.triangles)
            for (const std::uint32_t corner : triangle) ASSERT_LT(corner, scene.vertices.size());
        for (const std::uint32_t material : scene.triangle_material)
            ASSERT_LT(material, scene.materials.size());
    }
}

TEST(Embedded, TheTextIsTheFilesBytes) {
    const char* source = std::getenv("REGATHER_SOURCE_DIR");
    if (source == nullptr) GTEST_SKIP() << "REGATHER_SOURCE_DIR is set by ctest";
    for (const EmbeddedScene& entry : catalogue()) {
        std::ifstream file(std::string(source) + "/scenes/embedded/" + std::string(entry.name) + ".json",
                           std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        EXPECT_EQ(entry.text, text) << entry.name;
    }
}

TEST(Embedded, TheCameraIsInsideTheScenesBounds) {
    for (const EmbeddedScene& entry : catalogue()) {
        if (entry.name == "cornell") continue;  // Measured from before its open side.
        const Scene scene = load_scene(entry.name);
        const Bounds3 bounds = scene.bounds();
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GT(scene.camera.position[axis], bounds.min[axis]) << entry.name;
            EXPECT_LT(scene.camera.position[axis], bounds.max[axis]) << entry.name;
        }
    }
}

bool is_in_one_face(const Scene& scene, const Bounds3& bounds, const Corners& t) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {bounds.min[axis], bounds.max[axis]})
            if (scene.vertices[t[0]][axis] == side && scene.vertices[t[1]][axis] == side &&
                scene.vertices[t[2]][axis] == side)
                return true;
    return false;
}

// Walls, floor and ceiling come first in the files: the triangles whose corners lie in one face of the
// bounding box, up to the first that does not.
std::vector<Corners> shell(const Scene& scene) {
    const Bounds3 bounds = scene.bounds();
    std::vector<Corners> walls;
    for (const Corners& t : scene.triangles) {
        if (!is_in_one_face(scene, bounds, t)) break;
        walls.push_back(t);
    }
    return walls;
}

TEST(Embedded, TheWallsAreWatertightAndFaceInward) {
    const std::pair<const char*, double> volumes[] = {
        {"room", 10.0 * 8 * 3},    {"box", 2.0 * 2 * 2},      {"furnace", 1},
        {"house", 12.0 * 9 * 2.7}, {"arena", 24.0 * 18 * 6},  {"caustics", 4.0 * 4 * 2.6},
        {"prism", 5.0 * 5 * 3},    {"meadow", 7.0 * 7 * 3.6}, {"keyhole", 7.6 * 4 * 2.6}};
    for (const auto& [name, expected] : volumes) {
        const Scene scene = load_scene(name);
        const std::vector<Corners> walls = shell(scene);
        EXPECT_EQ(unpaired_edges(scene.vertices, walls), 0u) << scene.name;
        EXPECT_NEAR(volume(scene.vertices, walls), -expected, 1e-2) << scene.name;
    }
}

TEST(Embedded, TheRoomIsOfMediumComplexityWithEveryKindOfMaterial) {
    const Scene room = load_scene("room");
    EXPECT_GE(room.triangles.size(), 10'000u);
    EXPECT_LE(room.triangles.size(), 60'000u);
    std::vector<bool> kinds(4);
    for (const std::uint32_t m : room.triangle_material)
        kinds[static_cast<std::size_t>(room.materials[m].kind)] = true;
    EXPECT_EQ(kinds, std::vector<bool>(4, true));
    ASSERT_EQ(room.lights.size(), 1u);
    EXPECT_EQ(room.lights[0].normal(), (Vec3{0, 0, -1}));
}

TEST(Embedded, NothingInTheRoomReachesThroughItsWalls) {
    const Bounds3 bounds = load_scene("room").bounds();
    EXPECT_EQ(bounds.min, (Vec3{0, 0, 0}));
    EXPECT_EQ(bounds.max, (Vec3{10, 8, 3}));
}

TEST(Embedded, LessThanHalfOfTheRoomIsWithinTheCamerasView) {
    // By area and without occlusion, which only hides more.
    const Scene room = load_scene("room");
    const Camera& camera = room.camera;
    const Vec3 forward = normalize(camera.target - camera.position);
    const Vec3 right = normalize(cross(forward, camera.up)), up = cross(right, forward);
    const float half = std::tan(camera.vertical_fov_degrees * 3.14159265f / 360);
    double all = 0, in_view = 0;
    for (const auto& [a, b, c] : room.triangles) {
        const Vec3 p = room.vertices[a], q = room.vertices[b], r = room.vertices[c];
        const double area = length(cross(q - p, r - p)) / 2;
        const Vec3 to = (p + q + r) * (1.0f / 3) - camera.position;
        const float depth = dot(to, forward);
        all += area;
        if (depth > 0 && std::abs(dot(to, right)) < half * depth && std::abs(dot(to, up)) < half * depth)
            in_view += area;
    }
    EXPECT_LT(in_view / all, 0.5);
    EXPECT_GT(in_view / all, 0.1);
}

TEST(Embedded, TheDemonstrationScenesAreOfMediumComplexityWithEveryKindOfMaterialAndAnOrigin) {
    for (const char* name : {"house", "arena", "caustics", "prism"}) {
        const Scene scene = load_scene(name);
        EXPECT_GE(scene.triangles.size(), 10'000u) << name;
        EXPECT_LE(scene.triangles.size(), 100'000u) << name;
        std::vector<bool> kinds(4);
        for (const std::uint32_t m : scene.triangle_material)
            kinds[static_cast<std::size_t>(scene.materials[m].kind)] = true;
        EXPECT_EQ(kinds, std::vector<bool>(4, true)) << name;
        EXPECT_FALSE(scene.lights.empty()) << name;
        EXPECT_NE(scene.origin, "") << name;
        EXPECT_NE(scene.licence, "") << name;
        EXPECT_EQ(scene.degenerate_faces_dropped, 0u) << name;
        EXPECT_EQ(scene.recentred_by, (std::array<double, 3>{})) << name;
    }
}

TEST(Embedded, NoGlassOrWaterIsOpen) {
    // An open dielectric lets rays in that never come out.
    for (const char* name : {"house", "arena", "caustics", "prism"}) {
        const Scene scene = load_scene(name);
        for (std::size_t m = 0; m < scene.materials.size(); ++m) {
            if (scene.materials[m].kind != MaterialKind::dielectric) continue;
            std::vector<Corners> skin;
            for (std::size_t t = 0; t < scene.triangles.size(); ++t)
                if (scene.triangle_material[t] == m) skin.push_back(scene.triangles[t]);
            EXPECT_EQ(unpaired_edges(scene.vertices, skin), 0u) << name << ": " << scene.materials[m].name;
            if (!skin.empty()) {
                EXPECT_GT(volume(scene.vertices, skin), 0) << name << ": " << scene.materials[m].name;
            }
        }
    }
}

TEST(Embedded, TheCornellBoxHasTheMeasuredSizes) {
    // The published millimetres: floor 552.8 by 559.2 (549.6 at the back), ceiling at 548.8, 556.0 wide;
    // blocks of 165 and 330.
    const Scene cornell = load_scene("cornell");
    const Bounds3 bounds = cornell.bounds();
    EXPECT_EQ(bounds.min, (Vec3{-0.556f, 0, 0}));
    EXPECT_EQ(bounds.max, (Vec3{0, 0.5592f, 0.5488f}));
    ASSERT_EQ(cornell.lights.size(), 1u);
    const AreaLight& light = cornell.lights[0];
    EXPECT_NEAR(light.area(), 0.13 * 0.105, 1e-8);
    EXPECT_EQ(light.normal(), (Vec3{0, 0, -1}));
    EXPECT_EQ(cornell.camera.position, (Vec3{-0.278f, -0.8f, 0.273f}));
    EXPECT_NEAR(cornell.camera.vertical_fov_degrees,
                2 * std::atan(0.025 / 2 / 0.035) * 180 / 3.14159265358979, 1e-3);
    // Every triangle faces the inside of the box, or away from a block's middle.
    std::size_t inward = 0;
    for (std::size_t t = 0; t < 5 * 2 * 24 * 24; ++t) {
        const auto [a, b, c] = cornell.triangles[t];
        const Vec3 p = cornell.vertices[a];
        const Vec3 normal = cross(cornell.vertices[b] - p, cornell.vertices[c] - p);
        if (dot(normal, Vec3{-0.278f, 0.28f, 0.27f} - p) > 0) ++inward;
    }
    EXPECT_EQ(inward, 5u * 2 * 24 * 24);
    const auto tallest = [&](float low, float high) {
        float most = 0;
        for (const Vec3 p : cornell.vertices)
            if (p.x > low && p.x < high && p.y > 0.1f && p.y < 0.4f && p.z < 0.5f) most = std::max(most, p.z);
        return most;
    };
    EXPECT_EQ(tallest(-0.2f, -0.15f), 0.165f);
    EXPECT_EQ(tallest(-0.4f, -0.35f), 0.33f);
}

TEST(Embedded, TheMeadowHasAHundredThousandBlades) {
    // 4600 clumps of 22 blades (14 + 6 + 2, 12 + 8 + 2, 15 + 4 + 3, 10 + 10 + 2, 16 + 5 + 1), five triangles
    // each.
    const Scene meadow = load_scene("meadow");
    std::uint64_t blades = 0;
    double area = 0;
    for (std::size_t t = 0; t < meadow.triangles.size(); ++t) {
        const Material& material = meadow.materials[meadow.triangle_material[t]];
        EXPECT_EQ(material.kind, MaterialKind::diffuse);
        if (material.name.find("grass") == std::string::npos) continue;
        ++blades;
        const auto [a, b, c] = meadow.triangles[t];
        area += meshes::triangle_area(meadow.vertices[a], meadow.vertices[b], meadow.vertices[c]);
    }
    EXPECT_EQ(blades, 4600u * 22 * 5);
    // High detail: more surface than the ground below has, in pieces of a few square centimetres.
    EXPECT_GT(area, 49);
    EXPECT_LT(area / 101'200, 0.002);
    EXPECT_EQ(meadow.lights.size(), 2u);
}

TEST(Embedded, InTheDarkRoomOfTheKeyholeNoPointCanSeeTheLight) {
    // All of the room lies behind the lamp, which emits forward only: from x = 4.75, where the bright room
    // begins.
    const Scene keyhole = load_scene("keyhole");
    ASSERT_EQ(keyhole.lights.size(), 1u);
    const AreaLight& lamp = keyhole.lights[0];
    EXPECT_EQ(lamp.normal(), (Vec3{1, 0, 0}));
    std::size_t dark = 0, glossy = 0;
    std::set<std::string> glossy_names;
    for (std::size_t t = 0; t < keyhole.triangles.size(); ++t) {
        const Material& material = keyhole.materials[keyhole.triangle_material[t]];
        if (material.kind == MaterialKind::glossy) {
            ++glossy;
            glossy_names.insert(material.name);
        } else {
            EXPECT_EQ(material.kind, MaterialKind::diffuse);
        }
        bool inside = true;
        for (const std::uint32_t corner : keyhole.triangles[t])
            inside = inside && keyhole.vertices[corner].x <= 4.75f;
        if (!inside) continue;
        ++dark;
        for (const std::uint32_t corner : keyhole.triangles[t])
            EXPECT_LT(dot(keyhole.vertices[corner] - lamp.corner, lamp.normal()), -0.04f);
    }
    EXPECT_GT(dark, keyhole.triangles.size() / 2);
    EXPECT_GT(glossy, 0u);
    EXPECT_EQ(glossy_names.size(), 1u);
    EXPECT_LT(keyhole.camera.position.x, 4.6f);
    for (const KeyFrame& key : keyhole.camera_path) EXPECT_LT(key.position.x, 4.6f);
}

TEST(Embedded, TheFurnaceEmitsEvenlyFromAllOfItsTriangles) {
    const Scene furnace = load_scene("furnace");
    EXPECT_EQ(furnace.triangles.size(), 12u);
    ASSERT_EQ(furnace.lights.size(), 6u);
    for (const std::int32_t light : furnace.triangle_light) EXPECT_GE(light, 0);
    for (const AreaLight& light : furnace.lights) {
        EXPECT_EQ(light.radiance, (Vec3{1, 1, 1}));
        // Inward: towards the middle of the box.
        EXPECT_GT(dot(light.normal(), Vec3{0.5f, 0.5f, 0.5f} - light.corner), 0);
    }
    for (const std::uint32_t m : furnace.triangle_material)
        EXPECT_EQ(furnace.materials[m].diffuse, (Vec3{0.5f, 0.5f, 0.5f}));
}

TEST(Embedded, TheBoxIsSmall) {
    EXPECT_LT(load_scene("box").triangles.size(), 100u);
}

}  // namespace
}  // namespace regather::scenes
