// Scenes for records of irradiance, and others.
#include "capture/irradiance/open_surfaces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/scene.h"
#include "tests/capture/small_scenes.h"

namespace regather::capture {
namespace {

using trace::Vec3;

// Five walls of a box: all is met and diffuse, and all but the rays along its edges go on.
TEST(OpenSurfaces, WallsGoOn) {
    const OpenSurfaces walls = open_surfaces(closed_box(0.5));
    EXPECT_EQ(walls.met, 64u * 64);
    EXPECT_GT(walls.open, walls.diffuse * 9 / 10);
    EXPECT_LT(walls.open, walls.diffuse);
    EXPECT_TRUE(walls.suited());
}

/// Upright strips of a 64th of the picture, one near, one far, one near, before a camera that sees nothing
/// else.
scenes::Scene blades() {
    scenes::Scene scene = closed_box(0.5);
    const float tall = 100;
    scene.vertices.clear();
    scene.triangles.clear();
    scene.camera.position = {0, 0, 0};
    scene.camera.target = {0, 0, 1};
    scene.camera.up = {0, 1, 0};
    scene.camera.vertical_fov_degrees = 90;
    for (std::uint32_t i = 0; i < 64; ++i) {
        const float z = i % 2 == 0 ? 1.f : 2.f, left = (static_cast<float>(i) - 32) / 32 * z,
                    right = (static_cast<float>(i) - 31) / 32 * z;
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        for (const Vec3 corner : {Vec3{left, -tall, z}, {right, -tall, z}, {right, tall, z}, {left, tall, z}})
            scene.vertices.push_back(corner);
        scene.triangles.push_back({first, first + 1, first + 2});
        scene.triangles.push_back({first, first + 2, first + 3});
    }
    scene.normals.assign(scene.vertices.size(), {});
    scene.triangle_material.assign(scene.triangles.size(), 0);
    scene.triangle_light.assign(scene.triangles.size(), -1);
    return scene;
}

TEST(OpenSurfaces, BladesDoNotAndGlossIsNotDiffuse) {
    const OpenSurfaces grass = open_surfaces(blades());
    EXPECT_EQ(grass.met, 64u * 64);
    EXPECT_EQ(grass.diffuse, grass.met);
    EXPECT_LE(grass.open, 64u) << "those of the last column at most";
    EXPECT_FALSE(grass.suited());
    scenes::Scene lying = blades();
    lying.camera.up = {1, 0, 0};
    EXPECT_LE(open_surfaces(lying).open, 64u) << "those of the last row at most";
    EXPECT_THAT(grass.text(), testing::HasSubstr("100 % of what the camera sees is diffuse, "));
    scenes::Scene shiny = closed_box(0.5);
    for (scenes::Material& material : shiny.materials) material.kind = scenes::MaterialKind::glossy;
    EXPECT_EQ(open_surfaces(shiny).diffuse, 0u);
    EXPECT_FALSE(open_surfaces(shiny).suited());
}

TEST(OpenSurfaces, NothingIsMetOutside) {
    scenes::Scene scene = closed_box(0.5);
    scene.camera.position = {0, 0, 50};
    scene.camera.target = {0, 0, 60};
    const OpenSurfaces nothing = open_surfaces(scene);
    EXPECT_EQ(nothing.met, 0u);
    EXPECT_FALSE(nothing.suited());
    EXPECT_THAT(nothing.text(), testing::StartsWith("0 % "));
}

}  // namespace
}  // namespace regather::capture
