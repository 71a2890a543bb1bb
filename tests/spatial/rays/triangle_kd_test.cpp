#include "spatial/rays/triangle_kd.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "tests/spatial/rays/soup.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using trace::Bounds3;
using trace::Vec3;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
TriangleKd kd_of(const Soup& soup, const TriangleKdConfig& config = {}) {
    return TriangleKd(soup.vertices, soup.triangles, config);
}

/// Triangles 0 to 3 with boxes of 1 x 1 x 1 along x. With costs 15 (node) and 20 (triangle), by hand, in half
/// areas (2 length + 1): the whole splits at 3 (2 x 7 + 2 x 9, the least), its lower half at 1 (3 + 5 over 7,
/// a tie with 2), the upper first at 4 (nothing below, so 0.8 x (15 + 20 x 14/9) = 36.9 against 37.2 at 5),
/// then at 5.
///   x      0     1     2     3     4     5     6     7
///          [ t0  ]     [ t1  ]     [ t2  ]     [ t3  ]
///   label  |--0--|-----1-----|--2--|--3--|-----4-----|
Soup four_in_a_row() {
    Soup soup;
    for (const float x : {0.0f, 2.0f, 4.0f, 6.0f}) soup.add_spanning({x, 0, 0}, {x + 1, 1, 1});
    return soup;
}

TEST(TriangleKd, SplitsFourTrianglesInARowAsByHand) {
    const TriangleKd tree = kd_of(four_in_a_row());
    ASSERT_EQ(tree.leaf_count(), 5u);
    EXPECT_EQ(
        tree.stats(),
        (TriangleKdStats{.inner_nodes = 4, .leaves = 5, .empty_leaves = 1, .references = 4, .depth = 3}));
    const std::vector<float> planes{0, 1, 3, 4, 5, 7};
    for (std::size_t leaf = 0; leaf < 5; ++leaf)
        EXPECT_EQ(tree.leaf_bounds()[leaf], (Bounds3{{planes[leaf], 0, 0}, {planes[leaf + 1], 1, 1}}));
    EXPECT_THAT(tree.triangles_of_leaf(0), ElementsAre(0));
    EXPECT_THAT(tree.triangles_of_leaf(1), ElementsAre(1));
    EXPECT_THAT(tree.triangles_of_leaf(2), IsEmpty());
    EXPECT_THAT(tree.triangles_of_leaf(3), ElementsAre(2));
    EXPECT_THAT(tree.triangles_of_leaf(4), ElementsAre(3));
}

TEST(TriangleKd, APointOnAPlaneLiesInTheLowerLeafAndOneOutsideInTheNearest) {
    const TriangleKd tree = kd_of(four_in_a_row());
    const auto leaf_at = [&](float x) { return tree.leaf_of({x, 0.5f, 0.5f}); };
    EXPECT_EQ(leaf_at(0.5f), 0u);
    EXPECT_EQ(leaf_at(1), 0u);
    EXPECT_EQ(leaf_at(std::nextafter(1.0f, 2.0f)), 1u);
    EXPECT_EQ(leaf_at(3), 1u);
    EXPECT_EQ(leaf_at(3.5f), 2u);
    EXPECT_EQ(leaf_at(5), 3u);
    EXPECT_EQ(leaf_at(7), 4u);
    EXPECT_EQ(leaf_at(-100), 0u);
    EXPECT_EQ(leaf_at(-endless), 0u);
    EXPECT_EQ(leaf_at(100), 4u);
    EXPECT_EQ(leaf_at(endless), 4u);
    EXPECT_EQ(tree.leaf_of({3.5f, -9, 99}), 2u);
    EXPECT_EQ(leaf_at(nan), 0u);
    EXPECT_EQ(tree.leaf_of({6, nan, 0}), 0u);
    EXPECT_EQ(tree.leaf_of({6, 0, nan}), 0u);
}

// Long in x, so x is split first: both cells of the lower x come before both of the upper x.
TEST(TriangleKd, LabelsRunDepthFirstLowerSideFirst) {
    Soup soup;
    soup.add_spanning({30, 10, 0}, {31, 11, 1});
    soup.add_spanning({0, 10, 0}, {1, 11, 1});
    soup.add_spanning({30, 0, 0}, {31, 1, 1});
    soup.add_spanning({0, 0, 0}, {1, 1, 1});
    const TriangleKd tree = kd_of(soup);
    const std::vector<std::uint32_t> labels{
        tree.leaf_of({0.5f, 0.5f, 0.5f}), tree.leaf_of({0.5f, 10.5f, 0.5f}),
        tree.leaf_of({30.5f, 0.5f, 0.5f}), tree.leaf_of({30.5f, 10.5f, 0.5f})};
    EXPECT_TRUE(std::is_sorted(labels.begin(), labels.end()));
    EXPECT_EQ(std::adjacent_find(labels.begin(), labels.end()), labels.end());
    EXPECT_EQ(labels.front(), 0u);
    EXPECT_EQ(labels.back(), tree.leaf_count() - 1);
}

/// The half-open box (min, max], closed where min is the root's.
bool contains(const Bounds3& leaf, const Bounds3& root, Vec3 p) {
    for (int axis = 0; axis < 3; ++axis) {
        const bool above =
            p[axis] > leaf.min[axis] || (leaf.min[axis] == root.min[axis] && p[axis] == root.min[axis]);
        if (!above || p[axis] > leaf.max[axis]) return false;
    }
    return true;
}

TEST(TriangleKd, EachPointLiesInTheBoxOfItsLeafAndInNoOther) {
    const Soup soup = random_soup(300, 0.2f, 1);
    const TriangleKd tree = kd_of(soup);
    const std::vector<Bounds3> leaves = tree.leaf_bounds();
    ASSERT_EQ(leaves.size(), tree.leaf_count());
    ASSERT_GT(leaves.size(), 300u);
    std::mt19937 random(2);
    std::vector<Vec3> points = soup.vertices;  // These lie on split planes.
    for (int i = 0; i < 2000; ++i)
        points.push_back(tree.bounds().min + uniform3(random) * tree.bounds().extent());
    for (const Vec3 p : points)
        for (std::uint32_t label = 0; label < leaves.size(); ++label)
            ASSERT_EQ(contains(leaves[label], tree.bounds(), p), tree.leaf_of(p) == label);
}

/// On one axis: does [low, high] reach inside the leaf? A flat triangle counts as a point.
bool reaches_inside(const Bounds3& triangle, const Bounds3& leaf, const Bounds3& root, int axis) {
    const float low = triangle.min[axis], high = triangle.max[axis];
    if (low < high) return low < leaf.max[axis] && high > leaf.min[axis];
    return low <= leaf.max[axis] &&
           (low > leaf.min[axis] || (low == leaf.min[axis] && low == root.min[axis]));
}

TEST(TriangleKd, ALeafListsExactlyTheTrianglesWhoseBoxReachesInside) {
    for (const unsigned seed : {3u, 4u}) {
        const Soup soup = random_soup(400, seed == 3 ? 0.1f : 0.6f, seed);
        const TriangleKd tree = kd_of(soup);
        const std::vector<Bounds3> boxes = triangle_bounds(soup.vertices, soup.triangles),
                                   leaves = tree.leaf_bounds();
        for (std::uint32_t label = 0; label < leaves.size(); ++label) {
            std::vector<std::uint32_t> expected;
            for (std::uint32_t t = 0; t < boxes.size(); ++t)
                if (reaches_inside(boxes[t], leaves[label], tree.bounds(), 0) &&
                    reaches_inside(boxes[t], leaves[label], tree.bounds(), 1) &&
                    reaches_inside(boxes[t], leaves[label], tree.bounds(), 2))
                    expected.push_back(t);
            ASSERT_THAT(tree.triangles_of_leaf(label), testing::ElementsAreArray(expected))
                << "leaf " << label;
        }
    }
}

TEST(TriangleKd, TheLeafOfAPointOnATriangleListsTheTriangle) {
    ASSERT_TRUE(rc::check([] {
        const unsigned seed = *rc::gen::arbitrary<unsigned>();
        const Soup soup = random_soup(*rc::gen::inRange<std::size_t>(1, 200), 0.3f, seed);
        const TriangleKd tree = kd_of(soup);
        const std::vector<Bounds3> boxes = triangle_bounds(soup.vertices, soup.triangles);
        std::mt19937 random(seed);
        for (std::uint32_t t = 0; t < boxes.size(); ++t) {
            const float u = 0.1f + 0.4f * uniform(random), v = 0.1f + 0.4f * uniform(random);
            Vec3 p = soup.corner(t, 0) * (1 - u - v) + soup.corner(t, 1) * u + soup.corner(t, 2) * v;
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = std::clamp(p[axis], boxes[t].min[axis], boxes[t].max[axis]);
            const auto listed = tree.triangles_of_leaf(tree.leaf_of(p));
            RC_ASSERT(std::binary_search(listed.begin(), listed.end(), t));
        }
    }));
}

TEST(TriangleKd, ConsecutiveLeavesAreNearEachOther) {
    EXPECT_LT(neighbour_distance(kd_of(random_soup(4000, 0.02f, 5)).leaf_bounds()), 0.2);
}

TEST(TriangleKd, AFlatTriangleInASplitPlaneLiesBelowIt) {
    Soup soup;
    soup.add_spanning({0, 0, 0}, {1, 1, 1});
    soup.add({1, 0, 0}, {1, 1, 0}, {1, 0, 1});
    soup.add_spanning({1, 0, 0}, {2, 1, 1});
    const TriangleKd tree = kd_of(soup, {.traversal_cost = 1});
    ASSERT_EQ(tree.leaf_count(), 2u);
    EXPECT_THAT(tree.triangles_of_leaf(0), ElementsAre(0, 1));
    EXPECT_THAT(tree.triangles_of_leaf(1), ElementsAre(2));
    EXPECT_EQ(tree.leaf_of({1, 0.25f, 0.25f}), 0u);
}

// Flat ones at x = 0, 0.5, 4 and 6. By hand, in half areas as above: a plane at 0.5 costs 2 x 2 + 12 x 2 =
// 28, one at 4 costs 9 x 3 + 5 x 1 = 32. Were the flat one not counted below its plane, or above it too, 4
// would win.
TEST(TriangleKd, AFlatTriangleInAPlaneIsCountedBelowIt) {
    Soup soup;
    for (const float x : {0.0f, 0.5f, 4.0f, 6.0f}) soup.add({x, 0, 0}, {x, 1, 0}, {x, 1, 1});
    const TriangleKd tree = kd_of(soup, {.max_depth = 1});
    ASSERT_EQ(tree.leaf_count(), 2u);
    EXPECT_THAT(tree.triangles_of_leaf(0), ElementsAre(0, 1));
    EXPECT_THAT(tree.triangles_of_leaf(1), ElementsAre(2, 3));
}

TEST(TriangleKd, WithoutTrianglesEverythingLiesInTheOneLeaf) {
    const TriangleKd tree({}, {});
    EXPECT_EQ(tree.leaf_count(), 1u);
    EXPECT_EQ(tree.leaf_of({1, 2, 3}), 0u);
    EXPECT_EQ(tree.leaf_of({nan, 2, 3}), 0u);
    EXPECT_THAT(tree.triangles_of_leaf(0), IsEmpty());
    EXPECT_EQ(tree.leaf_bounds().size(), 1u);
}

TEST(TriangleKd, OneTriangleIsOneLeaf) {
    Soup soup;
    soup.add_spanning({0, 0, 0}, {1, 1, 1});
    const TriangleKd tree = kd_of(soup);
    EXPECT_EQ(tree.leaf_count(), 1u);
    EXPECT_THAT(tree.triangles_of_leaf(0), ElementsAre(0));
}

TEST(TriangleKd, DuplicatesCannotBeToldApartAndShareALeaf) {
    Soup soup;
    for (int i = 0; i < 1000; ++i) soup.add_spanning({0, 0, 0}, {1, 1, 1});
    const TriangleKd tree = kd_of(soup);
    EXPECT_EQ(tree.leaf_count(), 1u);
    EXPECT_EQ(tree.triangles_of_leaf(0).size(), 1000u);
}

TEST(TriangleKd, TrianglesOfNoAreaAreKept) {
    Soup points, line;
    for (int i = 0; i < 100; ++i) {
        points.add({1, 1, 1}, {1, 1, 1}, {1, 1, 1});
        line.add({float(i), 0, 0}, {float(i), 0, 0}, {float(i + 1), 0, 0});
    }
    EXPECT_EQ(kd_of(points).stats().references, 100u);
    EXPECT_EQ(kd_of(line).leaf_count(), 1u);
    Soup needles = random_soup(100, 0.1f, 6);
    for (TriangleIndices& triangle : needles.triangles) triangle[2] = triangle[1];
    EXPECT_GE(kd_of(needles).stats().references, 100u);
}

TEST(TriangleKd, ASceneInOnePlaneIsSplitInThePlane) {
    for (int axis = 0; axis < 3; ++axis) {
        Soup soup = random_soup(500, 0.05f, 7);
        for (Vec3& vertex : soup.vertices) vertex[axis] = 0.25f;
        const TriangleKd tree = kd_of(soup);
        EXPECT_GT(tree.leaf_count(), 200u);
        for (std::size_t v = 0; v < soup.vertices.size(); v += 10) {
            Vec3 lifted = soup.vertices[v];
            lifted[axis] += 3;
            EXPECT_EQ(tree.leaf_of(lifted), tree.leaf_of(soup.vertices[v]));
        }
    }
}

// Each triangle has a third of the extent of the next: without a limit the tree is a chain.
TEST(TriangleKd, NoLeafIsDeeperThanAsked) {
    Soup soup;
    float size = 1;
    for (int i = 0; i < 64; ++i, size /= 3) soup.add_spanning({0, 0, 0}, {size, size, size});
    EXPECT_EQ(kd_of(soup, {.max_depth = 5}).stats().depth, 5u);
    EXPECT_EQ(kd_of(soup).stats().depth, 15u);  // 8 + 1.3 x log2(64), rounded down
}

TEST(TriangleKd, NodesOfTheLeafSizeAreNotSplit) {
    const Soup soup = four_in_a_row();
    EXPECT_EQ(kd_of(soup, {.leaf_size = 4}).leaf_count(), 1u);
    EXPECT_EQ(kd_of(soup, {.leaf_size = 3}).leaf_count(), 2u);
}

template <class Error, class Call>
void expect_refused(Call call, const char* message) {
    try {
        call();
        ADD_FAILURE() << "accepted, expected: " << message;
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), message);
    }
}

TEST(TriangleKd, RefusesBadTrianglesByNumber) {
    Soup soup = four_in_a_row();
    soup.triangles[2][1] = 12;
    expect_refused<trace::DataError>([&] { kd_of(soup); },
                                     "triangle 2: found vertex index 12, expected one under 12");
    soup = four_in_a_row();
    soup.vertices[10].y = nan;
    expect_refused<trace::DataError>(
        [&] { kd_of(soup); }, "triangle 3: found nan in vertex 10, expected a number from -1e+18 to 1e+18");
    soup.vertices[10].y = -endless;
    expect_refused<trace::DataError>(
        [&] { kd_of(soup); }, "triangle 3: found -inf in vertex 10, expected a number from -1e+18 to 1e+18");
}

TEST(TriangleKd, RefusesAConfigOutOfRange) {
    const Soup soup = four_in_a_row();
    EXPECT_THROW(kd_of(soup, {.max_depth = 65}), trace::UsageError);
    EXPECT_THROW(kd_of(soup, {.traversal_cost = 0}), trace::UsageError);
    EXPECT_THROW(kd_of(soup, {.intersection_cost = nan}), trace::UsageError);
    EXPECT_THROW(kd_of(soup, {.empty_space_factor = 1.5f}), trace::UsageError);
}

TEST(TriangleKd, HugeScenesSplit) {
    Soup soup = random_soup(200, 0.1f, 9);
    for (Vec3& vertex : soup.vertices) vertex = vertex * 8e17f;
    EXPECT_GT(kd_of(soup).leaf_count(), 100u);
}

}  // namespace
}  // namespace regather::spatial
