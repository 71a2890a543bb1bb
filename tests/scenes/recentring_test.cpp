#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenes/scene_text.h"

namespace regather::scenes {
namespace {

using ::testing::HasSubstr;

// A scene of 4 m with a light, all of it moved by `by` along each axis.
std::string moved_scene(double by) {
    const auto at = [by](double x, double y, double z) {
        return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x + by, y + by, z + by);
    };
    SceneText text;
    text.camera = R"({"position": )" + at(0, -3, 1) + R"(, "target": )" + at(0, 0, 1) +
                  R"(, "up": [0, 0, 1], "vertical_fov_degrees": 50})";
    text.shapes =
        R"({"type": "quad", "material": "white", "corner": )" + at(-2, -2, 0) +
        R"(, "edge_u": [4, 0, 0], "edge_v": [0, 4, 0], "divide": [8, 8]}, {"type": "sphere", "material": "white", "center": )" +
        at(0.5, 0.5, 1) +
        R"(, "radius": 0.3, "segments": 24}, {"type": "mesh", "material": "white", "file": "t.obj", "translate": )" +
        at(-1, 0, 0.25) + R"(}, {"type": "cylinder", "material": "white", "from": )" + at(1, 1, 0) +
        R"(, "to": )" + at(1, 1, 2) + R"(, "radius": 0.1, "segments": 12})";
    text.lights = R"({"corner": )" + at(-0.5, -0.5, 3) +
                  R"(, "edge_u": [0, 1, 0], "edge_v": [1, 0, 0], "power": [9, 9, 9]})";
    std::string whole = text.text();
    whole.insert(1, R"("camera_path": {"frames": 2, "keys": [{"frame": 0, "position": )" + at(0, -3, 1) +
                        R"(, "target": )" + at(0, 0, 1) + R"(}, {"frame": 1, "position": )" + at(0, -2, 1) +
                        R"(, "target": )" + at(0, 0, 1) + "}]}, ");
    return whole;
}

class Recentring : public ::testing::Test {
protected:
    Recentring() { folder_.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n"); }
    Scene load(double by) const { return parse_scene(moved_scene(by), "t.json", folder_.path()); }
    ScratchFolder folder_;
};

TEST_F(Recentring, ASceneNearTheOriginStaysWhereItIs) {
    for (const double by : {0.0, 20.0, 150.0})
        EXPECT_EQ(load(by).recentred_by, (std::array<double, 3>{})) << by;
}

TEST_F(Recentring, AMovedSceneIsTheUnmovedOneToFloatRounding) {
    const Scene still = load(0);
    for (const double by : {5000.0, 1e6, 123456789.0, 1e9, -1e9, 1e12 - 100}) {
        const Scene moved = load(by);
        ASSERT_EQ(moved.triangles, still.triangles) << by;
        EXPECT_EQ(moved.triangle_material, still.triangle_material);
        // Doubles at 1e12 are 1.2e-4 m apart; ours and the file's own rounding each take half.
        const double tolerance = 2e-6 + std::abs(by) * 2.3e-16;
        const auto expect_same = [&](Vec3 a, Vec3 b) {
            for (int axis = 0; axis < 3; ++axis)
                ASSERT_NEAR(a[axis] + moved.recentred_by[static_cast<std::size_t>(axis)] - by, b[axis],
                            tolerance)
                    << by;
        };
        for (std::size_t v = 0; v < still.vertices.size(); ++v)
            expect_same(moved.vertices[v], still.vertices[v]);
        expect_same(moved.camera.position, still.camera.position);
        expect_same(moved.camera.target, still.camera.target);
        expect_same(moved.camera_path[1].position, still.camera_path[1].position);
        expect_same(moved.lights[0].corner, still.lights[0].corner);
        for (const double taken : moved.recentred_by) {
            EXPECT_NEAR(taken, by, 8);
            EXPECT_EQ(taken, std::round(taken));
        }
    }
}

TEST_F(Recentring, WhatIsBeyondTheLimitsIsRefused) {
    EXPECT_THAT(refusal(moved_scene(1e13), folder_.path()), HasSubstr("camera.position[0]: found 1"));
    SceneText wide;
    wide.shapes = R"({"type": "box", "material": "white", "min": [-2e6, 0, 0], "max": [2e6, 1, 1]})";
    EXPECT_EQ(refusal(wide.text()), "t.json: scene: found a size of 4e+06 m, expected at most 2e+06");
}

TEST_F(Recentring, AMeshIsPlacedInDoublesToo) {
    // Its own floats keep the shape, the translation carries the distance.
    const Scene moved = load(1e9), still = load(0);
    const std::size_t triangle = 2 * 64 + 2 * 24 * 11;
    const auto [a, b, c] = moved.triangles[triangle];
    EXPECT_EQ(moved.vertices[b] - moved.vertices[a], (Vec3{1, 0, 0}));
    EXPECT_EQ(moved.vertices[c] - moved.vertices[a], (Vec3{0, 1, 0.5f}));
}

}  // namespace
}  // namespace regather::scenes
