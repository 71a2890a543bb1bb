#include "scenes/tessellation.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>

#include "tests/scenes/closed_surface.h"

namespace regather::scenes {
namespace {

double area(const Surface& surface) {
    double sum = 0;
    for (const auto& [a, b, c] : surface.triangles)
        sum += triangle_area(surface.vertices[a], surface.vertices[b], surface.vertices[c]);
    return sum;
}

TEST(Tessellation, AreaOfATriangleIsHalfBaseTimesHeight) {
    EXPECT_DOUBLE_EQ(triangle_area({1, 1, 1}, {4, 1, 1}, {1, 1, 5}), 6);
    EXPECT_DOUBLE_EQ(triangle_area({0, 0, 0}, {1, 1, 1}, {3, 3, 3}), 0);
}

TEST(Tessellation, AQuadFacesAlongTheCrossProductAndKeepsItsAreaWhenDivided) {
    const Quad quad{{1, 2, 3}, {2, 0, 0}, {0, 3, 0}, {4, 5}};
    const Surface surface = tessellate(quad);
    EXPECT_EQ(surface.triangles.size(), 40u);
    EXPECT_EQ(triangle_count(quad), 40u);
    EXPECT_NEAR(area(surface), 6, 1e-5);
    for (const auto& [a, b, c] : surface.triangles) {
        const Vec3 normal =
            cross(surface.vertices[b] - surface.vertices[a], surface.vertices[c] - surface.vertices[a]);
        EXPECT_GT(normal.z, 0);
    }
    EXPECT_EQ(surface.normals.size(), surface.vertices.size());
    EXPECT_EQ(surface.normals[0], Vec3{});  // flat
}

TEST(Tessellation, AQuadsCornersAreExact) {
    const Surface surface = tessellate(Quad{{0.1f, 0.2f, 0.3f}, {0.7f, 0, 0}, {0, 0.9f, 0}, {1, 1}});
    EXPECT_EQ(surface.vertices[0], (Vec3{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(surface.vertices[3], (Vec3{0.1f + 0.7f, 0.2f + 0.9f, 0.3f}));
}

TEST(Tessellation, ABoxIsClosedAndFacesOutwardWhereverItStands) {
    ASSERT_TRUE(rc::check([] {
        const auto length = [] { return static_cast<float>(*rc::gen::inRange(1, 5000)) / 1000.0f; };
        const auto place = [] { return static_cast<float>(*rc::gen::inRange(-9000, 9000)) / 1000.0f; };
        const auto cells = [] { return *rc::gen::inRange<std::uint32_t>(1, 7); };
        Box box;
        box.min = {place(), place(), place()};
        const Vec3 size{length(), length(), length()};
        box.max = box.min + size;
        box.rotate_z_degrees = *rc::gen::inRange(-360, 361);
        box.divide = {cells(), cells(), cells()};
        const Surface surface = tessellate(box);
        const Vec3 extent = box.max - box.min;
        RC_ASSERT(surface.triangles.size() == triangle_count(box));
        RC_ASSERT(unpaired_edges(surface) == 0u);
        const double expected = double{extent.x} * extent.y * extent.z;
        RC_ASSERT(std::abs(volume(surface) - expected) < 1e-4 + 1e-4 * expected);
        RC_ASSERT(degenerate_count(surface) == 0u);
    }));
}

TEST(Tessellation, ABoxHasItsAnalyticVolumeAndArea) {
    const Surface surface = tessellate(Box{{-1, 0, 2}, {1, 3, 6}, 0, {2, 3, 4}});
    EXPECT_EQ(surface.triangles.size(), 4u * (2 * 3 + 3 * 4 + 4 * 2));
    EXPECT_NEAR(volume(surface), 24, 1e-5);
    EXPECT_NEAR(area(surface), 52, 1e-5);
}

TEST(Tessellation, ABoxIsClosedWhereItsSidesDifferByManyMagnitudes) {
    // -1e6 + (1e-10 + 1e6) is not 1e-10, not even in doubles.
    const Surface surface = tessellate(Box{{-1e6f, 0, 0}, {1e-10f, 1, 1}, 0, {2, 1, 1}});
    EXPECT_EQ(unpaired_edges(surface), 0u);
}

TEST(Tessellation, ARotatedBoxTurnsCounterClockwiseAboutItsCentre) {
    // 4 x 2 box about (2, 1): after 90 degrees it spans x in [1, 3], y in [-1, 3]; its corner (4, 0) goes to
    // (3, 3).
    const Surface surface = tessellate(Box{{0, 0, 0}, {4, 2, 1}, 90});
    const Surface still = tessellate(Box{{0, 0, 0}, {4, 2, 1}});
    for (std::size_t i = 0; i < surface.vertices.size(); ++i)
        if (still.vertices[i].x == 4 && still.vertices[i].y == 0) {
            EXPECT_NEAR(surface.vertices[i].x, 3, 1e-6);
            EXPECT_NEAR(surface.vertices[i].y, 3, 1e-6);
        }
}

TEST(Tessellation, ASphereIsClosedHasNoDegenerateTriangleAndFacesOutward) {
    for (const std::uint32_t segments : {3u, 4u, 5u, 8u, 17u, 64u, 129u}) {
        const Sphere sphere{{3, -2, 1}, 0.25f, segments};
        const Surface surface = tessellate(sphere);
        EXPECT_EQ(surface.triangles.size(), triangle_count(sphere));
        EXPECT_EQ(unpaired_edges(surface), 0u) << segments;
        EXPECT_EQ(degenerate_count(surface), 0u) << segments;
        EXPECT_GT(volume(surface), 0);
        // Euler: V - E + F = 2 with 3 F = 2 E.
        EXPECT_EQ(surface.vertices.size(), surface.triangles.size() / 2 + 2) << segments;
    }
}

TEST(Tessellation, ASpheresAreaAndVolumeConvergeWithTheSquareOfTheSegments) {
    const double exact_area = 4 * std::numbers::pi * 4, exact_volume = 4 * std::numbers::pi / 3 * 8;
    const auto lost_area = [&](std::uint32_t n) { return exact_area - area(tessellate(Sphere{{}, 2, n})); };
    const auto lost_volume = [&](std::uint32_t n) {
        return exact_volume - volume(tessellate(Sphere{{}, 2, n}));
    };
    EXPECT_LT(lost_area(256) / exact_area, 2e-4);
    EXPECT_LT(lost_volume(256) / exact_volume, 3e-4);
    EXPECT_NEAR(lost_area(32) / lost_area(64), 4, 0.1);
    EXPECT_NEAR(lost_volume(32) / lost_volume(64), 4, 0.1);
}

TEST(Tessellation, ASpheresNormalsAreUnitAndRadial) {
    const Sphere sphere{{1, 2, 3}, 0.5f, 24};
    const Surface surface = tessellate(sphere);
    ASSERT_EQ(surface.normals.size(), surface.vertices.size());
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
        EXPECT_NEAR(length(surface.normals[i]), 1, 1e-6);
        const Vec3 radial = (surface.vertices[i] - sphere.center) * (1 / sphere.radius);
        EXPECT_NEAR(length(radial - surface.normals[i]), 0, 2e-6);
    }
}

TEST(Tessellation, TrianglesWithoutAreaAreCountedAndDropped) {
    Surface surface;
    surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    surface.normals.resize(4);
    surface.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 0, 2}};  // good, on a line, two equal corners
    EXPECT_EQ(degenerate_count(surface), 2u);
    EXPECT_EQ(drop_degenerate(surface), 2u);
    ASSERT_EQ(surface.triangles.size(), 1u);
    EXPECT_EQ(surface.triangles[0], (Corners{0, 1, 2}));
}

}  // namespace
}  // namespace regather::scenes
