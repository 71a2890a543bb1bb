#include "spatial/rays/triangle_bvh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "tests/spatial/rays/soup.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

using testing::ElementsAreArray;
using trace::Bounds3;
using trace::Vec3;

TriangleBvh bvh_of(const Soup& soup, const TriangleBvhConfig& config = {}) {
    return TriangleBvh(soup.vertices, soup.triangles, config);
}

std::vector<std::uint32_t> labels_of(const Soup& soup, const TriangleBvhConfig& config = {}) {
    const TriangleBvh tree = bvh_of(soup, config);
    std::vector<std::uint32_t> labels;
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) labels.push_back(tree.leaf_of_triangle(t));
    return labels;
}

// Whatever the splits: along a row, lower child first means from left to right.
TEST(TriangleBvh, LabelsOfARowRunFromLeftToRight) {
    for (int axis = 0; axis < 3; ++axis) {
        Soup soup;
        std::vector<std::uint32_t> expected;
        for (std::uint32_t i = 0; i < 64; ++i) {
            const std::uint32_t place = i * 37 % 64;  // A permutation, as 37 is odd.
            Vec3 low;
            low[axis] = float(2 * place);
            soup.add_spanning(low, low + Vec3{1, 1, 1});
            expected.push_back(place);
        }
        EXPECT_THAT(labels_of(soup, {.leaf_size = 1}), ElementsAreArray(expected)) << "axis " << axis;
    }
}

// Two long triangles (2, 3) side by side, and a small one (0, 1) at the lower end of each. By hand, in half
// areas: small with small costs 2 x 5 + 2 x 302 = 614, small with long 4 x 201 = 804, and no further split
// pays.
TEST(TriangleBvh, SplitsWhereTheSurfaceAreaIsLeast) {
    for (int axis = 0; axis < 3; ++axis) {
        Soup soup;
        for (const float length : {1.0f, 100.0f})
            for (const float aside : {0.0f, 1.0f}) {
                Vec3 low, high{1, 1, 1};
                high[axis] = length;
                low[(axis + 1) % 3] = aside;
                high[(axis + 1) % 3] = aside + 1;
                soup.add_spanning(low, high);
            }
        EXPECT_THAT(labels_of(soup, {.leaf_size = 2}), testing::ElementsAre(0, 0, 1, 1)) << "axis " << axis;
    }
}

TEST(TriangleBvh, EachTriangleLiesInExactlyOneLeaf) {
    const Soup soup = random_soup(5000, 0.05f, 1);
    const TriangleBvh tree = bvh_of(soup, {.leaf_size = 20, .intersection_cost = 0.1f});
    const auto count = std::uint32_t(soup.triangles.size());
    std::vector<int> met(count);
    for (std::uint32_t label = 0; label < tree.leaf_count(); ++label) {
        const auto listed = tree.triangles_of_leaf(label);
        ASSERT_GE(listed.size(), 1u);
        ASSERT_LE(listed.size(), 20u);
        ASSERT_TRUE(std::is_sorted(listed.begin(), listed.end()));
        for (const std::uint32_t t : listed) {
            ASSERT_LT(t, count);
            ++met[t];
            ASSERT_EQ(tree.leaf_of_triangle(t), label);
        }
    }
    EXPECT_EQ(std::count(met.begin(), met.end(), 1), count);
}

TEST(TriangleBvh, ConsecutiveLeavesAreNearEachOther) {
    const Soup soup = random_soup(5000, 0.02f, 3);
    const TriangleBvh tree = bvh_of(soup);
    std::vector<Bounds3> boxes;
    for (std::uint32_t label = 0; label < tree.leaf_count(); ++label) {
        std::vector<Vec3> corners;
        for (const std::uint32_t t : tree.triangles_of_leaf(label))
            for (std::size_t i = 0; i < 3; ++i) corners.push_back(soup.corner(t, i));
        boxes.push_back(trace::bounds_of(corners));
    }
    EXPECT_LT(neighbour_distance(boxes), 0.2);
}

TEST(TriangleBvh, OneAndTwoThreadsGiveTheSameLabels) {
    const tbb::global_control two_threads(tbb::global_control::max_allowed_parallelism, 2);
    Soup soup = random_soup(30'000, 0.02f, 4);
    const Soup copies = soup;
    for (std::size_t t = 0; t < 5000; ++t)
        soup.add(copies.corner(t, 0), copies.corner(t, 1), copies.corner(t, 2));
    const std::vector<std::uint32_t> expected = labels_of(soup);
    for (const int threads : {1, 2, 2, 2}) {
        std::vector<std::uint32_t> found;
        tbb::task_arena(threads).execute([&] { found = labels_of(soup); });
        EXPECT_EQ(found, expected) << threads << " threads";
    }
    std::vector<std::vector<std::uint32_t>> side_by_side(4);
    tbb::parallel_for(0, 4, [&](int i) { side_by_side[std::size_t(i)] = labels_of(soup); });
    EXPECT_THAT(side_by_side, testing::Each(expected));
}

TEST(TriangleBvh, LabelsDoNotDependOnTheOrderOfTheTriangles) {
    const Soup soup = random_soup(5000, 0.05f, 5);
    Soup reversed = soup;
    std::reverse(reversed.triangles.begin(), reversed.triangles.end());
    std::vector<std::uint32_t> labels = labels_of(reversed);
    std::reverse(labels.begin(), labels.end());
    EXPECT_EQ(labels, labels_of(soup));
}

TEST(TriangleBvh, WithoutTrianglesThereIsNoLeaf) {
    const TriangleBvh tree({}, {});
    EXPECT_EQ(tree.leaf_count(), 0u);
}

TEST(TriangleBvh, OneTriangleIsOneLeaf) {
    Soup soup;
    soup.add_spanning({0, 0, 0}, {1, 2, 3});
    const TriangleBvh tree = bvh_of(soup);
    ASSERT_EQ(tree.leaf_count(), 1u);
    EXPECT_EQ(tree.leaf_of_triangle(0), 0u);
    EXPECT_EQ(tree.depth(), 0u);
}

// Nothing tells them apart but their numbers, which must decide.
TEST(TriangleBvh, DuplicatesAreDealtToLeavesByNumber) {
    Soup soup;
    for (int i = 0; i < 1000; ++i) soup.add_spanning({0, 0, 0}, {1, 1, 1});
    const std::vector<std::uint32_t> labels = labels_of(soup);
    EXPECT_TRUE(std::is_sorted(labels.begin(), labels.end()));
    EXPECT_GE(labels.back(), 249u);
    Soup points;
    for (int i = 0; i < 1000; ++i) points.add({1, 1, 1}, {1, 1, 1}, {1, 1, 1});
    EXPECT_EQ(labels_of(points), labels);
}

TEST(TriangleBvh, ASceneInOnePlaneIsSplitInThePlane) {
    for (int axis = 0; axis < 3; ++axis) {
        Soup soup = random_soup(500, 0.05f, 6);
        for (Vec3& vertex : soup.vertices) vertex[axis] = 0.25f;
        EXPECT_GE(bvh_of(soup).leaf_count(), 125u);
    }
}

// Halving distances towards one corner makes the deepest trees: each split cuts off one triangle.
TEST(TriangleBvh, DeepTreesAreBuilt) {
    Soup soup;
    float size = 1e18f;
    for (int i = 0; i < 120; ++i, size /= 2)
        soup.add_spanning({size / 2, 0, 0}, {size, size / 1000, size / 1000});
    const TriangleBvh tree = bvh_of(soup, {.leaf_size = 1});
    EXPECT_EQ(tree.leaf_count(), 120u);
    const std::vector<std::uint32_t> labels = labels_of(soup, {.leaf_size = 1});
    EXPECT_TRUE(std::is_sorted(labels.rbegin(), labels.rend()));
}

TEST(TriangleBvh, RefusesBadTrianglesAndConfigs) {
    Soup soup = random_soup(10, 0.1f, 7);
    EXPECT_THROW(bvh_of(soup, {.leaf_size = 0}), trace::UsageError);
    EXPECT_THROW(bvh_of(soup, {.leaf_size = 33}), trace::UsageError);
    EXPECT_THROW(bvh_of(soup, {.traversal_cost = -1}), trace::UsageError);
    EXPECT_THROW(bvh_of(soup, {.intersection_cost = std::numeric_limits<float>::infinity()}),
                 trace::UsageError);
    soup.triangles[4][2] = 30;
    EXPECT_THROW(bvh_of(soup), trace::DataError);
    soup.triangles[4][2] = 0;
    soup.vertices[0].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(bvh_of(soup), trace::DataError);
}

}  // namespace
}  // namespace regather::spatial
