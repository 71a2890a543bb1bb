// Hierarchies of other shapes than the renderer's: what a ray hits is the same in all of them.
#include "spatial/rays/ray_bvh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "spatial/rays/cast.h"
#include "tests/spatial/rays/soup.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

using trace::Vec3;

std::vector<std::vector<std::uint32_t>> leaves_of(const RayBvh& bvh) {
    std::vector<std::vector<std::uint32_t>> leaves;
    for (const RayBvh::Block& block : bvh.blocks())
        leaves.emplace_back(block.triangles, block.triangles + block.count);
    std::sort(leaves.begin(), leaves.end());
    return leaves;
}

std::uint32_t children_of(const RayBvh::Node& node) {
    std::uint32_t count = 0;
    while (count < RayBvh::width && node.children[count] != 0) ++count;
    return count;
}

TEST(RayBvh, WiderNodesHaveTheSameLeaves) {
    const Soup soup = random_soup(2000, 0.1f, 51);
    for (const std::uint32_t leaf : {1u, 3u, 8u}) {
        const RayBvh binary(soup.vertices, soup.triangles, {.node_width = 2, .leaf_triangles = leaf});
        EXPECT_EQ(binary.nodes().size() + 1, binary.blocks().size());
        for (const std::uint32_t width : {2u, 4u, 5u, 8u}) {
            const RayBvh bvh(soup.vertices, soup.triangles, {.node_width = width, .leaf_triangles = leaf});
            EXPECT_EQ(leaves_of(bvh), leaves_of(binary));
            for (const RayBvh::Node& node : bvh.nodes()) {
                EXPECT_TRUE(children_of(node) >= 2 && children_of(node) <= width);
                // A node with room has leaves alone: an inner child would have been taken in.
                for (std::uint32_t i = 0; children_of(node) < width && i < children_of(node); ++i)
                    EXPECT_TRUE(node.children[i] & RayBvh::leaf_bit);
            }
            for (const RayBvh::Block& block : bvh.blocks()) EXPECT_LE(block.count, leaf);
        }
    }
}

TEST(RayBvh, EightTrianglesInARowCollapseAsDrawn) {
    Soup soup;
    for (int i = 0; i < 8; ++i) {
        const auto x = static_cast<float>(3 * i);
        soup.add({x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0});
    }
    const auto nodes = [&](std::uint32_t width) {
        return RayBvh(soup.vertices, soup.triangles, {.node_width = width, .leaf_triangles = 1})
            .nodes()
            .size();
    };
    // Halves of halves; four quarters of two; all eight.
    EXPECT_EQ(nodes(2), 7u);
    EXPECT_EQ(nodes(4), 5u);
    EXPECT_EQ(nodes(8), 1u);
    // The quarters are larger than their triangles: they are taken in first, so the root holds no leaf.
    const RayBvh four(soup.vertices, soup.triangles, {.node_width = 4, .leaf_triangles = 1});
    for (const std::uint32_t child : four.nodes()[0].children) EXPECT_FALSE(child & RayBvh::leaf_bit);
}

TEST(RayBvh, EveryShapeIsHitAlike) {
    const Soup soup = random_soup(1500, 0.1f, 52);
    const RayBvh renderers(soup.vertices, soup.triangles);
    for (const std::uint32_t width : {2u, 4u, 8u})
        for (const bool quantised : {false, true}) {
            const RayBvh bvh(soup.vertices, soup.triangles,
                             {.node_width = width, .leaf_triangles = 4, .quantised = quantised});
            std::mt19937 random(53);
            for (int i = 0; i < 1000; ++i) {
                const Vec3 from = uniform3(random) * 3 - Vec3{1, 1, 1}, to = uniform3(random);
                const Ray ray{from, to - from};
                const Meeting expected = closest(renderers, ray), met = closest(bvh, ray);
                ASSERT_EQ(met.triangle, expected.triangle);
                ASSERT_EQ(met.distance, expected.distance);
                ASSERT_EQ(occluded(bvh, ray), expected.found());
            }
        }
}

TEST(RayBvh, QuantisedPlanesLieOutsideOnAGridOf255Steps) {
    const Soup soup = random_soup(600, 0.3f, 54);
    const RayBvh::Shape shape{.node_width = 4, .leaf_triangles = 2};
    RayBvh::Shape coarse = shape;
    coarse.quantised = true;
    const RayBvh fine(soup.vertices, soup.triangles, shape), grid(soup.vertices, soup.triangles, coarse);
    ASSERT_EQ(fine.nodes().size(), grid.nodes().size());
    bool moved = false;
    for (std::size_t n = 0; n < fine.nodes().size(); ++n) {
        const RayBvh::Node &before = fine.nodes()[n], &after = grid.nodes()[n];
        for (int axis = 0; axis < 3; ++axis) {
            float lower = before.planes[axis][0][0], upper = before.planes[axis][1][0];
            for (std::uint32_t i = 1; i < children_of(before); ++i) {
                lower = std::min(lower, before.planes[axis][0][i]);
                upper = std::max(upper, before.planes[axis][1][i]);
            }
            if (lower == upper) continue;
            // The least power of two above 1/255 of the extent.
            double step = 0x1p-60;
            while (!(step * 255 > double{upper} - double{lower})) step *= 2;
            for (std::uint32_t i = 0; i < children_of(before); ++i) {
                const float low = after.planes[axis][0][i], high = after.planes[axis][1][i];
                ASSERT_LE(low, before.planes[axis][0][i]);
                ASSERT_GE(high, before.planes[axis][1][i]);
                ASSERT_LT(double{before.planes[axis][0][i]} - double{low}, step * 1.001);
                ASSERT_LT(double{high} - double{before.planes[axis][1][i]}, step * 1.001);
                for (const float plane : {low, high}) {
                    const double steps = (double{plane} - double{lower}) / step;
                    ASSERT_NEAR(steps, std::round(steps), 0.01);
                    ASSERT_TRUE(steps > -0.01 && steps < 255.01);
                }
                moved |= low < before.planes[axis][0][i];
            }
        }
    }
    EXPECT_TRUE(moved);
}

TEST(RayBvh, AShapeOutOfRangeIsRefused) {
    const Soup soup = random_soup(3, 0.3f, 55);
    for (const RayBvh::Shape& shape :
         {RayBvh::Shape{.node_width = 1}, RayBvh::Shape{.node_width = 9}, RayBvh::Shape{.leaf_triangles = 0},
          RayBvh::Shape{.leaf_triangles = 9}})
        EXPECT_THROW(RayBvh(soup.vertices, soup.triangles, shape), trace::UsageError);
}

}  // namespace
}  // namespace regather::spatial
