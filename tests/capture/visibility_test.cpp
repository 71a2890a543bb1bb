#include "capture/visibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "capture/images/contact_sheet.h"
#include "capture/view_plane.h"
#include "scenes/camera_path.h"
#include "scenes/loader.h"
#include "scenes/tessellation.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

constexpr const char* with_paths[] = {"house", "arena", "cornell", "caustics", "prism", "meadow", "keyhole"};

Scene of_quads(const std::string& shapes) {
    return scenes::parse_scene(
        R"({"name": "t", "camera": {"position": [0, 0, 0], "target": [0, 1, 0], "up": [0, 0, 1],
        "vertical_fov_degrees": 90}, "materials": {"w": {"kind": "diffuse", "diffuse": [0.5, 0.5, 0.5]}}, "shapes": [)" +
            shapes + "]}",
        "t.json", {});
}

const std::string ahead =
    R"({"type": "quad", "material": "w", "corner": [-1, 2, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2]})";
const std::string hidden =
    R"({"type": "quad", "material": "w", "corner": [-1, 3, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2]})";
const std::string behind =
    R"({"type": "quad", "material": "w", "corner": [-1, -2, -1], "edge_u": [4, 0, 0], "edge_v": [0, 0, 2]})";

TEST(Visibility, OfThreeQuadsTheOneInFrontIsSeen) {
    const Scene scene = of_quads(ahead + "," + hidden + "," + behind);
    const RayCaster caster(scene);
    EXPECT_EQ(triangles_seen(scene, caster, scene.camera), (std::vector<std::uint8_t>{1, 1, 0, 0, 0, 0}));
    EXPECT_DOUBLE_EQ(share_seen(scene, caster, {&scene.camera, 1}), 4.0 / (4 + 4 + 8));
    scenes::Camera back = scene.camera;
    back.target = {0, -1, 0};
    const scenes::Camera both[] = {scene.camera, back};
    EXPECT_DOUBLE_EQ(share_seen(scene, caster, both), 12.0 / 16);
    EXPECT_EQ(share_seen(scene, caster, {}), 0);
}

TEST(Visibility, TheFieldOfViewIsTheCameras) {
    // At 90 degrees the picture at distance 2 reaches to +-2: a quad from 1.9 is seen, from 2.1 not.
    const auto aside = [](const char* corner) {
        return std::string(R"({"type": "quad", "material": "w", "corner": )") + corner +
               R"(, "edge_u": [2, 0, 0], "edge_v": [0, 0, 0.1]})";
    };
    for (const auto& [corner, seen] : {std::pair{"[1.9, 2, 0]", 1.0}, {"[2.1, 2, 0]", 0.0}}) {
        const Scene scene = of_quads(aside(corner));
        const RayCaster caster(scene);
        EXPECT_EQ(share_seen(scene, caster, {&scene.camera, 1}) > 0, seen > 0) << corner;
    }
}

TEST(EmbeddedScenes, LessThanHalfIsSeenButInTheMeasuredBox) {
    for (const char* name : {"room", "house", "arena", "caustics", "prism", "meadow", "keyhole"}) {
        const Scene scene = scenes::load_scene(name);
        const RayCaster caster(scene);
        const double share = share_seen(scene, caster, {&scene.camera, 1});
        EXPECT_LT(share, 0.5) << name;
        // Most blades of grass are finer than the grid's rays lie apart.
        EXPECT_GT(share, std::string(name) == "meadow" ? 0.03 : 0.05) << name;
    }
}

TEST(EmbeddedScenes, ThePathMeetsNoSurface) {
    // Straight from frame to frame nothing is in the way, and around each frame there is room.
    for (const char* name : with_paths) {
        const Scene scene = scenes::load_scene(name);
        const RayCaster caster(scene);
        for (std::uint32_t frame = 0; frame < scene.frames; ++frame) {
            const scenes::Camera camera = scenes::camera_at(scene, frame);
            for (int i = 0; i < 200; ++i) {  // Directions on a spiral.
                const double z = 1 - 2 * (i + 0.5) / 200, r = std::sqrt(1 - z * z),
                             phi = i * 2.399963229728653;
                const Vec3 direction{static_cast<float>(r * std::cos(phi)),
                                     static_cast<float>(r * std::sin(phi)), static_cast<float>(z)};
                ASSERT_FALSE(caster.occluded(camera.position, direction, 0.3f)) << name << " frame " << frame;
            }
            if (frame == 0) continue;
            const Vec3 from = scenes::camera_at(scene, frame - 1).position, step = camera.position - from;
            const float distance = length(step);
            ASSERT_GT(distance, 0) << name << " frame " << frame;
            ASSERT_LT(distance, 0.5f) << name << " frame " << frame;
            ASSERT_FALSE(caster.occluded(from, step * (1 / distance), distance))
                << name << " frame " << frame;
        }
    }
}

TEST(EmbeddedScenes, EachLightReachesSomething) {
    for (const char* name : with_paths) {
        const Scene scene = scenes::load_scene(name);
        const RayCaster caster(scene);
        for (std::size_t l = 0; l < scene.lights.size(); ++l) {
            // From the middle of its triangles along their normals.
            std::size_t far = 0, all = 0;
            for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
                if (scene.triangle_light[t] != static_cast<std::int32_t>(l)) continue;
                const auto [a, b, c] = scene.triangles[t];
                const Vec3 p = scene.vertices[a], q = scene.vertices[b], r = scene.vertices[c];
                const Vec3 normal = normalize(cross(q - p, r - p));
                const auto hit = caster.closest(caster.offset((p + q + r) * (1.0f / 3), normal), normal);
                ++all;
                if (hit && hit->distance > 0.02f && scene.triangle_light[hit->triangle] < 0) ++far;
            }
            EXPECT_GT(all, 0u);
            EXPECT_GT(2 * far, all) << name << " light " << l;
        }
    }
}

TEST(EmbeddedScenes, NoPixelOfTheKeyholeSeesTheLightOrALitSurface) {
    // In no frame does a ray from the eye meet a point of the bright room, where the lamp reaches, and from
    // none of the points met does a ray to the lamp arrive.
    const Scene scene = scenes::load_scene("keyhole");
    const RayCaster caster(scene);
    const scenes::AreaLight& lamp = scene.lights[0];
    std::vector<scenes::Camera> cameras{scene.camera};
    for (std::uint32_t frame = 0; frame < scene.frames; ++frame)
        cameras.push_back(scenes::camera_at(scene, frame));
    constexpr std::uint32_t edge = 96;
    std::size_t met = 0;
    for (const scenes::Camera& camera : cameras) {
        const ViewPlane plane(camera, edge, edge);
        for (std::uint32_t i = 0; i < edge * edge; ++i) {
            const Vec3 direction =
                plane.direction(static_cast<float>(i % edge) + 0.5f, static_cast<float>(i / edge) + 0.5f);
            const auto hit = caster.closest(camera.position, direction);
            ASSERT_TRUE(hit);
            const Vec3 point = camera.position + direction * hit->distance;
            ASSERT_LT(point.x, 4.75f);
            ASSERT_LT(scene.triangle_light[hit->triangle], 0);
            const Vec3 side =
                dot(hit->geometric_normal, direction) < 0 ? hit->geometric_normal : -hit->geometric_normal;
            for (const auto& [u, v] : {std::pair{0.03f, 0.9f}, {0.5f, 0.5f}, {0.97f, 0.2f}}) {
                const Vec3 to = lamp.corner + lamp.edge_u * u + lamp.edge_v * v - point;
                const float distance = length(to);
                const bool lit =
                    dot(to, lamp.normal()) < 0 && dot(to, side) > 0 &&
                    !caster.occluded(caster.offset(point, side), to * (1 / distance), distance * 0.999f);
                ASSERT_FALSE(lit);
            }
            ++met;
        }
    }
    EXPECT_EQ(met, std::size_t{37} * edge * edge);
}

TEST(ContactSheet, HasARowOfRenderingsInOrder) {
    const std::vector<Scene> two{scenes::load_scene("furnace"), scenes::load_scene("box")};
    const ContactSheetConfig config{
        .columns = 4, .edge = 24, .photons = 2000, .gather_rays = 1, .shadow_rays = 1, .k = 10};
    std::vector<std::string> told;
    const Image sheet =
        contact_sheet(two, config, [&](std::string_view name, std::size_t) { told.emplace_back(name); });
    EXPECT_EQ(told, (std::vector<std::string>{"furnace", "box"}));
    EXPECT_EQ(sheet.width, 6u + 2 * (24 + 6));
    EXPECT_EQ(sheet.height, 6u + 24 + 18 + 6);
    const auto pixel = [&](std::uint32_t x, std::uint32_t y) {
        return sheet.pixels[std::size_t{y} * sheet.width + x];
    };
    EXPECT_EQ(pixel(2, 2), (Vec3{0.9f, 0.9f, 0.9f}));
    // The furnace shines alike everywhere, as no other scene does, and not like the paper around it.
    for (const std::uint32_t at : {8u, 18u, 28u}) {
        EXPECT_NEAR(pixel(at, 18).x, pixel(18, 18).x, 0.1);
        EXPECT_LT(pixel(at, 18).x, 0.8f);
    }
    EXPECT_THROW(contact_sheet({}, config), trace::UsageError);
}

}  // namespace
}  // namespace regather::capture
