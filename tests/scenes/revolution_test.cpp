#include "scenes/revolution.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>

#include "tests/scenes/closed_surface.h"
#include "tests/scenes/scene_text.h"

namespace regather::scenes {
namespace {

constexpr double pi = std::numbers::pi;

// Of a regular polygon with n corners on the unit circle.
double polygon_area(std::uint32_t n) {
    return n / 2.0 * std::sin(2 * pi / n);
}

TEST(Revolution, ACylinderIsAPrismOverARegularPolygonWhereverItPoints) {
    ASSERT_TRUE(rc::check([] {
        const auto place = [] { return static_cast<float>(*rc::gen::inRange(-3000, 3000)) / 1000.0f; };
        Cylinder cylinder{{place(), place(), place()},
                          {place(), place(), place()},
                          0.75f,
                          0.75f,
                          *rc::gen::inRange(3u, 40u)};
        const double height = static_cast<double>(length(cylinder.to - cylinder.from));
        RC_PRE(height > 0.1);
        const Surface surface = tessellate(cylinder);
        RC_ASSERT(surface.triangles.size() == triangle_count(cylinder));
        RC_ASSERT(surface.triangles.size() == 4u * cylinder.segments);
        RC_ASSERT(unpaired_edges(surface) == 0u);
        RC_ASSERT(degenerate_count(surface) == 0u);
        const double expected = polygon_area(cylinder.segments) * 0.75 * 0.75 * height;
        RC_ASSERT(std::abs(volume(surface) - expected) < 1e-4 * (1 + expected));
    }));
}

TEST(Revolution, AConeHasAThirdOfTheVolume) {
    for (const bool up : {true, false}) {
        const Surface cone =
            tessellate(Cylinder{{1, 2, 3}, {1, 2, 6}, up ? 2.0f : 0.0f, up ? 0.0f : 2.0f, 24});
        EXPECT_EQ(unpaired_edges(cone), 0u);
        EXPECT_EQ(degenerate_count(cone), 0u);
        EXPECT_NEAR(volume(cone), polygon_area(24) * 4 * 3 / 3, 1e-4);
    }
}

TEST(Revolution, AClosedLatheIsWatertightAndFacesOutward) {
    // A goblet: out along the foot, up the outside, down the inside.
    const Lathe goblet{{0.3f, -0.2f, 0.1f},
                       {{0, 0}, {0.5f, 0}, {0.1f, 0.1f}, {0.1f, 1}, {0.6f, 1.5f}, {0.55f, 1.5f}, {0, 1.05f}},
                       31};
    const Surface surface = tessellate(goblet);
    EXPECT_EQ(surface.triangles.size(), triangle_count(goblet));
    EXPECT_EQ(unpaired_edges(surface), 0u);
    EXPECT_EQ(degenerate_count(surface), 0u);
    // Sum of frustums with sign: pi h (a^2 + a b + b^2) / 3, a polygon in place of the circle.
    double expected = 0;
    for (std::size_t i = 0; i + 1 < goblet.profile.size(); ++i) {
        const double a = goblet.profile[i][0], b = goblet.profile[i + 1][0],
                     h = goblet.profile[i + 1][1] - goblet.profile[i][1];
        expected += polygon_area(31) * h * (a * a + a * b + b * b) / 3;
    }
    EXPECT_GT(expected, 0);
    EXPECT_NEAR(volume(surface), expected, 1e-5);
}

TEST(Revolution, ALatheThatEndsWhereItBeganIsARing) {
    // A band of square section: 2 pi R times its area, by Pappus, on a polygon.
    const Surface band = tessellate(Lathe{{}, {{2, 0}, {2, 1}, {1, 1}, {1, 0}, {2, 0}}, 64});
    EXPECT_EQ(unpaired_edges(band), 0u);
    EXPECT_NEAR(volume(band), polygon_area(64) * (4 - 1), 1e-4);
}

TEST(Revolution, ATorusHasTheVolumeOfPappus) {
    for (const Vec3 axis : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{1, -2, 0.5f}}) {
        const Torus torus{{1, 1, 1}, axis, 3, 1, 96, 48};
        const Surface surface = tessellate(torus);
        EXPECT_EQ(surface.triangles.size(), triangle_count(torus));
        EXPECT_EQ(unpaired_edges(surface), 0u);
        EXPECT_EQ(degenerate_count(surface), 0u);
        EXPECT_NEAR(volume(surface), 2 * pi * 3 * pi, 0.01 * 2 * pi * 3 * pi);
        // Euler: V - E + F = 0 with 3 F = 2 E.
        EXPECT_EQ(surface.triangles.size(), 2u * 96 * 48);
    }
}

TEST(Revolution, NormalsAreUnitAndPointOutward) {
    const Surface torus = tessellate(Torus{{}, {0, 0, 1}, 2, 0.5f, 32, 16});
    for (std::size_t i = 0; i < torus.vertices.size(); ++i) {
        const Vec3 p = torus.vertices[i], ring = normalize(Vec3{p.x, p.y, 0}) * 2.0f;
        EXPECT_LT(length(torus.normals[i] - normalize(p - ring)), 1e-3f);
    }
    // A cylinder's rim is a crease: there a vertex of the side has no share in the disc's normal.
    const Surface cylinder = tessellate(Cylinder{{0, 0, 0}, {0, 0, 1}, 1, 1, 16});
    for (const Vec3 n : cylinder.normals) EXPECT_TRUE(std::abs(n.z) < 1e-6f || std::abs(n.z) > 1 - 1e-6f);
}

TEST(Revolution, AFlatOneHasNoNormals) {
    for (const Vec3 n : tessellate(Lathe{{}, {{0, 0}, {1, 0}, {0, 1}}, 3, false}).normals)
        EXPECT_EQ(n, Vec3{});
    for (const Vec3 n : tessellate(Cylinder{{0, 0, 0}, {0, 0, 1}, 1, 1, 3, false}).normals)
        EXPECT_EQ(n, Vec3{});
}

TEST(Ripple, AClosedOneIsWatertightAndHoldsTheWaterBelowIt) {
    const Ripple ripple{{1, 2, 3}, 2, 0.05f, 0.5f, 30, 0.4f, 48};
    const Surface surface = tessellate(ripple);
    EXPECT_EQ(surface.triangles.size(), triangle_count(ripple));
    EXPECT_EQ(unpaired_edges(surface), 0u);
    EXPECT_EQ(degenerate_count(surface), 0u);
    // 2 x 2 x depth, and the waves' mean, whose sum over the grid is a number of its own.
    double waves = 0;
    for (int j = 0; j < 400; ++j)
        for (int i = 0; i < 400; ++i) {
            const double x = (i + 0.5) / 200 - 1, y = (j + 0.5) / 200 - 1;
            waves += 0.05 * std::cos(2 * pi * std::hypot(x, y) / 0.5 - pi / 6) * 4 / 160000;
        }
    EXPECT_NEAR(volume(surface), 4 * 0.4 + waves, 2e-3);
}

TEST(Ripple, ItsNormalsAreThoseOfItsWaves) {
    const Ripple ripple{{0, 0, 0}, 2, 0.05f, 0.5f, 0, 0, 256};
    const Surface surface = tessellate(ripple);
    EXPECT_EQ(surface.triangles.size(), 2u * 256 * 256);
    // Against the finite difference of the height along x at a vertex on the x axis: row 128, column 200.
    const std::size_t v = 128 * 257 + 200;
    const double slope = (surface.vertices[v + 1].z - surface.vertices[v - 1].z) /
                         (static_cast<double>(surface.vertices[v + 1].x) - surface.vertices[v - 1].x);
    EXPECT_NEAR(-surface.normals[v].x / surface.normals[v].z, slope, 0.01);
    EXPECT_NEAR(surface.vertices[v].z, 0.05 * std::cos(2 * pi * surface.vertices[v].x / 0.5), 1e-6);
}

TEST(Patch, MeetsItsCornersAndIsBilinearBetween) {
    const Patch patch{{Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{2, 2, 4}, Vec3{0, 2, 0}}, {4, 2}};
    const Surface surface = tessellate(patch);
    EXPECT_EQ(surface.triangles.size(), triangle_count(patch));
    EXPECT_EQ(surface.vertices.front(), (Vec3{0, 0, 0}));
    EXPECT_EQ(surface.vertices[4], (Vec3{2, 0, 0}));
    EXPECT_EQ(surface.vertices.back(), (Vec3{2, 2, 4}));
    EXPECT_EQ(surface.vertices[7], (Vec3{1, 1, 1}));  // The middle: the mean of the corners.
    for (const auto& [a, b, c] : surface.triangles)
        EXPECT_GT(
            cross(surface.vertices[b] - surface.vertices[a], surface.vertices[c] - surface.vertices[a]).z, 0);
}

TEST(Instances, AreTheObjectTurnedThenMoved) {
    std::string text =
        SceneText{.shapes = R"({"type": "instances", "object": "o", "at": [[10, 20, 30], [0, 0, 5, 90]]})"}
            .text();
    text.insert(
        1,
        R"("objects": {"o": [{"type": "box", "material": "white", "min": [1, 0, 0], "max": [3, 1, 1]}]}, )");
    const Scene scene = parse(text);
    ASSERT_EQ(scene.triangles.size(), 24u);
    const Bounds3 first = trace::bounds_of(std::span(scene.vertices).first(scene.vertices.size() / 2));
    EXPECT_EQ(first.min, (Vec3{11, 20, 30}));
    EXPECT_EQ(first.max, (Vec3{13, 21, 31}));
    // (x, y) -> (-y, x)
    const Bounds3 second = trace::bounds_of(std::span(scene.vertices).last(scene.vertices.size() / 2));
    EXPECT_LT(length(second.min - Vec3{-1, 1, 5}), 1e-6f);
    EXPECT_LT(length(second.max - Vec3{0, 3, 6}), 1e-6f);
    EXPECT_EQ(scenes::unpaired_edges(scene.vertices, scene.triangles), 0u);
}

TEST(Instances, UnknownAndNestedObjectsAreRefused) {
    const std::string place = R"({"type": "instances", "object": "chiar", "at": [[0, 0, 0]]})";
    std::string text = SceneText{.shapes = place}.text();
    EXPECT_EQ(refusal(text),
              "t.json: shapes[0].object: found \"chiar\", expected an object, and the scene has none");
    std::string nested = text;
    nested.insert(1, R"("objects": {"chair": [)" + place + "]}, ");
    EXPECT_EQ(
        refusal(nested),
        "t.json: objects.chair[0].type: found \"instances\", expected a shape that is not made of objects");
    text.insert(
        1,
        R"("objects": {"chair": [{"type": "box", "material": "white", "min": [0, 0, 0], "max": [1, 1, 1]}]}, )");
    EXPECT_EQ(refusal(text), "t.json: shapes[0].object: found unknown object \"chiar\", expected \"chair\"");
}

}  // namespace
}  // namespace regather::scenes
