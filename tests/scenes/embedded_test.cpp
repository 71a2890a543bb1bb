#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "scenes/catalogue.h"
#include "scenes/loader.h"
#include "tests/scenes/closed_surface.h"

namespace regather::scenes {
namespace {

TEST(Embedded, EveryRowLoadsUnderItsOwnName) {
    ASSERT_EQ(catalogue().size(), 3u);
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
        const Scene scene = load_scene(entry.name);
        const Bounds3 bounds = scene.bounds();
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GT(scene.camera.position[axis], bounds.min[axis]) << entry.name;
            EXPECT_LT(scene.camera.position[axis], bounds.max[axis]) << entry.name;
        }
    }
}

// The triangles whose three corners lie in one face of the scene's bounding box: walls, floor and ceiling.
std::vector<Corners> shell(const Scene& scene) {
    const Bounds3 bounds = scene.bounds();
    std::vector<Corners> walls;
    for (const Corners& t : scene.triangles)
        for (int axis = 0; axis < 3; ++axis)
            for (const float side : {bounds.min[axis], bounds.max[axis]})
                if (scene.vertices[t[0]][axis] == side && scene.vertices[t[1]][axis] == side &&
                    scene.vertices[t[2]][axis] == side)
                    walls.push_back(t);
    return walls;
}

TEST(Embedded, TheWallsAreWatertightAndFaceInward) {
    const double volumes[] = {10.0 * 8 * 3, 2.0 * 2 * 2, 1};
    for (std::size_t i = 0; i < catalogue().size(); ++i) {
        const Scene scene = load_scene(catalogue()[i].name);
        const std::vector<Corners> walls = shell(scene);
        EXPECT_EQ(unpaired_edges(scene.vertices, walls), 0u) << scene.name;
        EXPECT_NEAR(volume(scene.vertices, walls), -volumes[i], 1e-3) << scene.name;
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
