#include "scenes/growth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/scenes/scene_text.h"

namespace regather::scenes {
namespace {

using testing::HasSubstr;

constexpr const char* ground =
    R"({"type": "terrain", "material": "white", "corner": [1, 2, 0.5], "size": [6, 4], "amplitude": 0.2,
    "wavelength": 1.5, "seed": 5, "cells": [3, 2], "growth": [)";

// Of 12 triangles, and of 24.
constexpr const char* objects =
    R"("peg": [{"type": "box", "material": "white", "min": [-0.01, -0.01, 0], "max": [0.01, 0.01, 0.1]}],
    "slab": [{"type": "box", "material": "white", "min": [-0.02, -0.02, 0], "max": [0.02, 0.02, 0.05]},
             {"type": "box", "material": "white", "min": [-0.02, -0.02, 0.06], "max": [0.02, 0.02, 0.07]}])";

std::string scene_with(const std::string& growth, const std::string& terrain = ground) {
    std::string text = SceneText{.shapes = terrain + growth + "]}"}.text();
    return text.insert(1, std::string(R"("objects": {)") + objects + "}, ");
}

struct Peg {
    double x, y, z, height;
};

// Of pegs, which follow 2 x 3 x 2 triangles of ground: the middle of the foot, and the height.
std::vector<Peg> pegs_in(const Scene& scene, std::size_t first_triangle = 12) {
    std::vector<Peg> pegs;
    for (std::size_t t = first_triangle; t < scene.triangles.size(); t += 12) {
        std::vector<Vec3> corners;
        for (std::size_t i = t; i < t + 12; ++i)
            for (const std::uint32_t corner : scene.triangles[i]) corners.push_back(scene.vertices[corner]);
        const Bounds3 bounds = trace::bounds_of(corners);
        pegs.push_back({(double{bounds.min.x} + bounds.max.x) / 2, (double{bounds.min.y} + bounds.max.y) / 2,
                        bounds.min.z, double{bounds.max.z} - bounds.min.z});
    }
    return pegs;
}

TEST(Growth, StandsOnTheGroundEvenlyInTheMarginAndOutsideOfClearings) {
    constexpr int n = 3000;
    const std::vector<Peg> pegs = pegs_in(parse(scene_with(
        R"({"objects": ["peg"], "count": 3000, "seed": 8, "margin": 0.5, "sink": 0.04, "clear": [[4, 4, 1], [2.5, 3, 0.5]]})")));
    ASSERT_EQ(pegs.size(), 3000u);
    const Terrain terrain{{1, 2, 0.5f}, {6, 4}, 0.2f, 1.5f, 5, {3, 2}};
    double mean_x = 0;
    int right = 0;  // Of x = 5, where there is no clearing: 1.5 x 3 of 15 - pi - pi / 4 square metres.
    for (const Peg& peg : pegs) {
        ASSERT_GE(peg.x, 1.5 - 1e-5);
        ASSERT_LE(peg.x, 6.5 + 1e-5);
        ASSERT_GE(peg.y, 2.5 - 1e-5);
        ASSERT_LE(peg.y, 5.5 + 1e-5);
        ASSERT_GE(std::hypot(peg.x - 4, peg.y - 4), 1 - 1e-5);
        ASSERT_GE(std::hypot(peg.x - 2.5, peg.y - 3), 0.5 - 1e-5);
        ASSERT_NEAR(peg.z, 0.5 + ground_at(terrain, peg.x - 1, peg.y - 2).height - 0.04, 1e-5);
        ASSERT_NEAR(peg.height, 0.1, 1e-6);
        mean_x += peg.x / n;
        if (peg.x > 5) ++right;
    }
    const double share = 4.5 / (15 - 1.25 * 3.14159265358979);
    EXPECT_NEAR(right, n * share, 4 * std::sqrt(n * share * (1 - share)));
    // Moment of the area about x = 1.5 less those of the discs, which lie 2.5 and 1 from there.
    const double pi = 3.14159265358979, area = 15 - 1.25 * pi,
                 mean = (15 * 2.5 - pi * 2.5 - pi / 4 * 1) / area;
    EXPECT_NEAR(mean_x, 1.5 + mean, 4 * 1.6 / std::sqrt(n));
}

TEST(Growth, TakesEachOfItsObjectsAlikeOftenInAnyTurnAndScale) {
    // A slab has 24 triangles, a peg 12: the total tells how many were taken.
    const Scene scene =
        parse(scene_with(R"({"objects": ["peg", "slab"], "count": 2000, "seed": 1, "scale": [0.5, 2]})"));
    const double slabs = static_cast<double>(scene.triangles.size() - 12 - 2000 * 12) / 12;
    EXPECT_NEAR(slabs, 1000, 4 * std::sqrt(500));

    const std::vector<Peg> pegs =
        pegs_in(parse(scene_with(R"({"objects": ["peg"], "count": 2000, "seed": 1, "scale": [0.5, 2]})")));
    double mean = 0;
    for (const Peg& peg : pegs) {
        ASSERT_GE(peg.height, 0.05 - 1e-6);
        ASSERT_LE(peg.height, 0.2 + 1e-6);
        mean += peg.height / 2000;
    }
    EXPECT_NEAR(mean, 0.125, 4 * 0.15 / std::sqrt(12.0 * 2000));

    const Terrain flat{{0, 0, 0}, {1, 1}, 0, 1, 0, {1, 1}};
    Growth growth;
    growth.objects = {"peg"};
    growth.count = 2000;
    const trace::Document document("{}", "t.json");
    double cosine = 0, cosine_square = 0;
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const Placement placement = place_of(growth, flat, i, document.root()).placement;
        ASSERT_NEAR(placement.cosine * placement.cosine + placement.sine * placement.sine, 1, 1e-12);
        cosine += placement.cosine / 2000;
        cosine_square += placement.cosine * placement.cosine / 2000;
    }
    EXPECT_NEAR(cosine, 0, 4 * std::sqrt(0.5 / 2000));
    EXPECT_NEAR(cosine_square, 0.5, 4 * std::sqrt(0.125 / 2000));
}

TEST(Growth, FarFromTheOriginIsTheSame) {
    const std::string growth = R"({"objects": ["peg"], "count": 300, "seed": 8, "clear": [[X, 4, 1]]})";
    const auto at = [&](const std::string& corner, const std::string& middle) {
        std::string terrain = ground, here = growth;
        terrain.replace(terrain.find("[1, 2, 0.5]"), 11, "[" + corner + ", 2, 0.5]");
        here.replace(here.find('X'), 1, middle);
        return parse(scene_with(here, terrain));
    };
    const Scene near = at("1", "4"), far = at("8388609", "8388612");
    ASSERT_NE(far.recentred_by[0], 0);
    ASSERT_EQ(far.vertices.size(), near.vertices.size());
    for (std::size_t v = 0; v < near.vertices.size(); ++v) {
        ASSERT_NEAR(far.vertices[v].x + far.recentred_by[0] - 8388608, near.vertices[v].x, 1e-5);
        ASSERT_NEAR(far.vertices[v].y + far.recentred_by[1], near.vertices[v].y, 1e-5);
        ASSERT_NEAR(far.vertices[v].z + far.recentred_by[2], near.vertices[v].z, 1e-5);
    }
}

TEST(GrowthRefuses, WhatIsWrongInItsKeys) {
    const auto refused = [](const std::string& keys) { return refusal(scene_with("{" + keys + "}")); };
    EXPECT_EQ(refused(R"("objects": ["peg"], "count": 1, "seed": 0)"), "");
    EXPECT_EQ(
        refused(R"("objects": [], "count": 1, "seed": 0)"),
        "t.json: shapes[0].growth[0].objects: found an empty list, expected a list of names of objects, at "
        "least one");
    EXPECT_EQ(refused(R"("objects": ["peg", "slap"], "count": 1, "seed": 0)"),
              "t.json: shapes[0].growth[0].objects[1]: found unknown object \"slap\", expected \"slab\"");
    EXPECT_THAT(refused(R"("objects": ["peg"], "count": 0, "seed": 0)"),
                HasSubstr("found 0, expected a whole number of places, from 1 to 1000000"));
    EXPECT_EQ(
        refused(R"("objects": ["peg"], "count": 1, "seed": 0, "margin": 2)"),
        "t.json: shapes[0].growth[0].margin: found 2, expected less than half of the terrain's edge, 2");
    EXPECT_THAT(refused(R"("objects": ["peg"], "count": 1, "seed": 0, "scale": [2, 1])"),
                HasSubstr("scale[1]: found 1, expected two factors, the least and the largest"));
    EXPECT_THAT(refused(R"("objects": ["peg"], "count": 1, "seed": 0, "clear": [[1, 2]])"),
                HasSubstr("clear[0]: found a list of 2, expected a list of discs [x, y, radius] in metres"));
    EXPECT_EQ(refused(R"("objects": ["peg"], "count": 1, "seed": 0, "clear": [[4, 4, 50]])"),
              "t.json: shapes[0].growth[0]: found no room for place 0 in 1000 tries, expected clearings that "
              "leave more of the terrain");
}

TEST(GrowthRefuses, ATerrainWithGrowthAsAnObject) {
    std::string text = SceneText{}.text();
    text.insert(1, std::string(R"("objects": {)") + objects + R"(, "hill": [)" + ground +
                       R"({"objects": ["peg"], "count": 1, "seed": 0}]}]}, )");
    EXPECT_EQ(refusal(text),
              "t.json: objects.hill[0].growth: found growth in an object, expected it in the "
              "scene's shapes");
}

}  // namespace
}  // namespace regather::scenes
