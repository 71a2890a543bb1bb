#include "imports/maps/patch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace regather::imports {
namespace {

// x^2 + z^2 = 1 is not a quadratic; the parabola through the same control points (1,0), (1,1), (0,1) is
// x = 1 - t^2, z = 2 t - t^2, straight along y from 0 to 2.
ControlNet quarter() {
    ControlNet net{3, 3, {}, {}};
    for (int row = 0; row < 3; ++row)
        for (const Vec3 p : {Vec3{1, 0, 0}, {1, 0, 1}, {0, 0, 1}}) {
            net.points.push_back({p.x, static_cast<float>(row), p.z});
            net.normals.push_back({1, 0, 1});
        }
    return net;
}

TEST(Patch, PointsLieOnTheQuadraticAndNormalsAcrossIt) {
    const Surface surface = tessellate(quarter(), 4);
    ASSERT_EQ(surface.vertices.size(), 25u);
    ASSERT_EQ(surface.triangles.size(), triangle_count(quarter(), 4));
    for (int v = 0; v <= 4; ++v) {
        for (int u = 0; u <= 4; ++u) {
            const double t = u / 4.0;
            const Vec3 p = surface.vertices[static_cast<std::size_t>(5 * v + u)];
            EXPECT_FLOAT_EQ(p.x, static_cast<float>(1 - t * t));
            EXPECT_FLOAT_EQ(p.y, static_cast<float>(v / 2.0));
            EXPECT_FLOAT_EQ(p.z, static_cast<float>(2 * t - t * t));
            const Vec3 n =
                surface.normals[static_cast<std::size_t>(5 * v + u)];  // The slope is (-t, 0, 1 - t).
            const double size = std::hypot(1 - t, t);
            EXPECT_NEAR(n.x, (1 - t) / size, 1e-6);
            EXPECT_NEAR(n.y, 0, 1e-6);
            EXPECT_NEAR(n.z, t / size, 1e-6);
        }
    }
}

TEST(Patch, WindingFollowsTheControlPointsNormals) {
    for (const float side : {1.0f, -1.0f}) {
        ControlNet net = quarter();
        for (Vec3& normal : net.normals) normal = normal * side;
        const Surface surface = tessellate(net, 3);
        for (const auto& [a, b, c] : surface.triangles) {
            const auto& v = surface.vertices;
            const Vec3 normal = cross(v[b] - v[a], v[c] - v[a]);
            EXPECT_GT(dot(normal, Vec3{side, 0, side}), 0);
            EXPECT_GT(dot(normal, surface.normals[a]), 0);
        }
    }
}

// Edges of nets that share their control points, in the same and in the opposite direction.
TEST(Patch, SharedEdgesHaveEqualVerticesToTheLastBit) {
    std::uint32_t state = 1;
    const auto number = [&] {
        state = state * 1664525u + 1013904223u;
        return static_cast<float>(state >> 8) / 65536.0f - 128;
    };
    for (int trial = 0; trial < 200; ++trial) {
        ControlNet left{3, 5, std::vector<Vec3>(15), std::vector<Vec3>(15, Vec3{0, 0, 1})}, right = left,
                                                                                            turned = left;
        for (ControlNet* net : {&left, &right, &turned})
            for (Vec3& p : net->points) p = {number(), number(), number()};
        for (std::size_t row = 0; row < 5; ++row) {
            right.points[3 * row] = left.points[3 * row + 2];
            turned.points[3 * row + 2] = left.points[3 * (4 - row) + 2];
        }
        const Surface a = tessellate(left, 6), b = tessellate(right, 6), c = tessellate(turned, 6);
        for (std::size_t row = 0; row < 13; ++row) {
            EXPECT_EQ(a.vertices[7 * row + 6], b.vertices[7 * row]);
            EXPECT_EQ(a.vertices[7 * row + 6], c.vertices[7 * (12 - row) + 6]);
        }
    }
}

TEST(Patch, ControlPointsAtEvenPlacesAreOnTheSurface) {
    ControlNet net{5, 3, {}, {}};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 5; ++column) {
            net.points.push_back({static_cast<float>(column), static_cast<float>(row),
                                  static_cast<float>((7 * column + 3 * row) % 5)});
            net.normals.push_back({0, 0, 1});
        }
    for (const std::uint32_t n : {1u, 2u, 7u}) {
        const Surface surface = tessellate(net, n);
        EXPECT_EQ(surface.triangles.size(), 4 * n * n);
        for (std::uint32_t column = 0; column <= 2; ++column)
            for (std::uint32_t row = 0; row <= 1; ++row)
                EXPECT_EQ(surface.vertices[row * n * (2 * n + 1) + column * n],
                          net.points[row * 2 * 5 + 2 * column]);
    }
}

TEST(Patch, ACollapsedEdgeHasFiniteUnitNormals) {
    ControlNet net = quarter();
    for (std::size_t column = 0; column < 3; ++column) net.points[column] = {0, 0, 0};
    for (const Vec3 normal : tessellate(net, 6).normals) EXPECT_NEAR(length(normal), 1, 1e-5);
}

}  // namespace
}  // namespace regather::imports
