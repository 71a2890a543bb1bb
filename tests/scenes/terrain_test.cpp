#include "scenes/terrain.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "scenes/draws.h"
#include "tests/scenes/scene_text.h"

namespace regather::scenes {
namespace {

Terrain hills() {
    return {{1, -2, 0.5f}, {6, 4.5f}, 0.3f, 1.7f, 5, {23, 31}};
}

TEST(Draws, AreThePublishedNumbersOfPhilox) {
    // Random123's known answers, kat_vectors: philox4x32 10 rounds, counter 0, key 0.
    static_assert(static_cast<std::uint32_t>(Draws::Purpose::terrain) == 0);
    Draws draws(0, Draws::Purpose::terrain, 0);
    for (const std::uint32_t word : {0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u})
        EXPECT_EQ(draws.next(), word * 0x1p-32);
    Draws again(0, Draws::Purpose::terrain, 0), other(0, Draws::Purpose::tuft, 0),
        next(0, Draws::Purpose::terrain, 1);
    const double first = again.next();
    EXPECT_NE(other.next(), first);
    EXPECT_NE(next.next(), first);
}

TEST(Draws, PointsOfTheDiscAreEvenAndThoseOfTheCircleOnIt) {
    // Evenly in a disc, the square of the distance is even in [0, 1]: mean 1/2, variance 1/12; x^2 has mean
    // 1/4.
    constexpr int n = 20000;
    double square = 0, x_square = 0;
    for (int i = 0; i < n; ++i) {
        Draws draws(7, Draws::Purpose::growth, static_cast<std::uint64_t>(i));
        const auto [x, y] = draws.in_disc();
        square += (x * x + y * y) / n;
        x_square += x * x / n;
        const auto [c, s] = draws.on_circle();
        ASSERT_NEAR(c * c + s * s, 1, 1e-15);
    }
    EXPECT_NEAR(square, 0.5, 4 * std::sqrt(1.0 / 12 / n));
    EXPECT_NEAR(x_square, 0.25, 4 * std::sqrt(1.0 / 16 / n));  // E x^4 = 1/8
}

TEST(Terrain, StaysWithinItsAmplitudeAndUsesIt) {
    const Terrain terrain = hills();
    double least = 0, most = 0;
    for (int i = 0; i < 200; ++i)
        for (int j = 0; j < 200; ++j) {
            const double height = ground_at(terrain, 6.0 * i / 199, 4.5 * j / 199).height;
            least = std::min(least, height);
            most = std::max(most, height);
        }
    EXPECT_GE(least, -0.3);
    EXPECT_LE(most, 0.3);
    EXPECT_GT(most - least, 0.2);
}

TEST(Terrain, SlopesAreTheDerivativesOfTheHeight) {
    ASSERT_TRUE(rc::check([] {
        Terrain terrain = hills();
        terrain.seed = *rc::gen::arbitrary<std::uint32_t>();
        const double x = *rc::gen::inRange(10, 5990) / 1000.0, y = *rc::gen::inRange(10, 4490) / 1000.0;
        constexpr double h = 1e-5;
        const Ground ground = ground_at(terrain, x, y);
        const double along_x = (ground_at(terrain, x + h, y).height - ground_at(terrain, x - h, y).height) /
                               (2 * h),
                     along_y = (ground_at(terrain, x, y + h).height - ground_at(terrain, x, y - h).height) /
                               (2 * h);
        RC_ASSERT(std::abs(ground.slope_x - along_x) < 1e-6);
        RC_ASSERT(std::abs(ground.slope_y - along_y) < 1e-6);
    }));
}

TEST(Terrain, IsLevelAtItsKnots) {
    // The quintic's slope is 0 at both ends, and a wavelength's knots are knots of its half and quarter, too.
    Terrain terrain = hills();
    terrain.wavelength = 1.5f;
    for (int i = 0; i <= 4; ++i)
        for (int j = 0; j <= 3; ++j) {
            const Ground ground = ground_at(terrain, 1.5 * i, 1.5 * j);
            EXPECT_EQ(ground.slope_x, 0);
            EXPECT_EQ(ground.slope_y, 0);
        }
    EXPECT_NE(ground_at(terrain, 1.5, 1.5).height, ground_at(terrain, 3, 1.5).height);
    EXPECT_NE(ground_at(terrain, 1.5, 3).height, ground_at(terrain, 3, 1.5).height);
}

TEST(Terrain, TheTrianglesCoverTheRectangleAndFaceUp) {
    const Terrain terrain = hills();
    const Surface surface = tessellate(terrain);
    EXPECT_EQ(triangle_count(terrain), 2u * 23 * 31);
    EXPECT_EQ(surface.triangles.size(), triangle_count(terrain));
    double area = 0;  // Seen from above.
    for (const auto& [a, b, c] : surface.triangles) {
        const Vec3 normal =
            cross(surface.vertices[b] - surface.vertices[a], surface.vertices[c] - surface.vertices[a]);
        ASSERT_GT(normal.z, 0);
        area += normal.z / 2;
        for (const std::uint32_t corner : {a, b, c}) ASSERT_GT(dot(normal, surface.normals[corner]), 0);
    }
    EXPECT_NEAR(area, 6 * 4.5, 1e-4);
    for (const Vec3 p : surface.vertices)
        EXPECT_NEAR(p.z, 0.5 + ground_at(terrain, p.x - 1, p.y + 2).height, 1e-6);
    EXPECT_EQ(surface.vertices.back().x, 7);
    EXPECT_EQ(surface.vertices.back().y, 2.5f);
}

TEST(Terrain, WithoutAmplitudeIsFlat) {
    Terrain terrain = hills();
    terrain.amplitude = 0;
    const Surface surface = tessellate(terrain);
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        EXPECT_EQ(surface.vertices[v].z, 0.5f);
        EXPECT_EQ(surface.normals[v], (Vec3{0, 0, 1}));
    }
}

TEST(Terrain, IsAnotherForAnotherSeed) {
    Terrain one = hills(), other = hills();
    EXPECT_EQ(tessellate(one).vertices, tessellate(other).vertices);
    other.seed = 6;
    EXPECT_NE(tessellate(one).vertices, tessellate(other).vertices);
}

TEST(TerrainRefuses, WhatIsWrongInItsKeys) {
    const auto refused = [](const std::string& size, const std::string& wavelength,
                            const std::string& cells) {
        return refusal(
            SceneText{.shapes = R"({"type": "terrain", "material": "white", "corner": [0, 0, 0], "size": )" +
                                size + R"(, "amplitude": 0.1, "wavelength": )" + wavelength +
                                R"(, "seed": 1, "cells": )" + cells + "}"}
                .text());
    };
    EXPECT_EQ(refused("[2, 3]", "1", "[4, 5]"), "");
    EXPECT_EQ(
        refused("[2]", "1", "[4, 5]"),
        "t.json: shapes[0].size: found a list of 1, expected two lengths [m], each above 0 and at most 1e6");
    EXPECT_EQ(refused("[2, 0]", "1", "[4, 5]"),
              "t.json: shapes[0].size[1]: found 0, expected two lengths [m], each above 0 and at most 1e6");
    EXPECT_EQ(refused("[2, 3]", "1", "[4]"),
              "t.json: shapes[0].cells: found a list of 1, expected two whole numbers of cells, each from 1 "
              "to 4096");
    EXPECT_EQ(
        refused("[200, 300]", "1e-5", "[4, 5]"),
        "t.json: shapes[0].wavelength: found 1e-05, expected at least a millionth of the terrain's edges");
}

}  // namespace
}  // namespace regather::scenes
