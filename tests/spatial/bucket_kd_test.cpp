// kd-trees with buckets: the photons found are the left-balanced tree's, their walks decode to the visits.
#include "spatial/photons/bucket_kd.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "spatial/photons/recording.h"
#include "spatial/tree_walk.h"
#include "spatial/walk.h"
#include "tests/spatial/brute_force.h"
#include "tests/spatial/photons.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

using testing::ElementsAre;

constexpr std::array rules{SplitRule::median, SplitRule::midpoint, SplitRule::voxel_volume};

struct Recorded {
    std::vector<std::uint32_t> visited;
    WalkRecorder recorder;
    void visit(std::uint32_t element) {
        visited.push_back(element);
        recorder.visit(element);
    }
    void near(bool upper) { recorder.near(upper); }
    void far(bool entered) { recorder.far(entered); }
};

TEST(BucketKd, FindsWhatLookingAtEveryPhotonFindsAndItsWalksDecode) {
    ASSERT_TRUE(rc::check([] {
        const std::vector<Photon> photons = *any_photons(200);
        const BucketKd tree(photons, {.rule = *rc::gen::elementOf(rules),
                                      .leaf_photons = *rc::gen::inRange<std::uint32_t>(1, 20),
                                      .radius = *rc::gen::element(0.0f, 0.3f, 100.0f),
                                      .bounds = *rc::gen::arbitrary<bool>()});
        const auto decoder = tree.shape().decoder();
        const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-4, 12)) * 0.5f; };
        const auto k = *rc::gen::inRange<std::uint32_t>(0, 30);
        const float radius = *rc::gen::element(infinity, 1.0f, 0.0f);
        NearestSet found(k, radius);
        Recorded search;
        const Vec3 point{coordinate(), coordinate(), coordinate()};
        nearest(tree, point, found, search);
        RC_ASSERT(same(found.nearest_first(), brute_force(photons, point, k, radius)));
        search.recorder.finish();
        const auto [fault, elements] = decoder->decode(search.recorder.bytes());
        RC_ASSERT(fault == WalkFault::none);
        RC_ASSERT(std::vector<std::uint32_t>(elements.begin(), elements.end()) == search.visited);
    }));
}

TEST(BucketKd, LeavesHoldEveryPhotonOnceAndNoMoreThanAsked) {
    for (const auto& photons : {uniform_photons(3000), clustered_photons(3000), std::vector<Photon>(700)})
        for (const SplitRule rule : rules)
            for (const std::uint32_t leaf : {1u, 7u, 64u}) {
                const BucketKd tree(photons, {.rule = rule, .leaf_photons = leaf, .radius = 0.05f});
                std::vector<std::uint32_t> at(tree.photon_at().begin(), tree.photon_at().end());
                std::sort(at.begin(), at.end());
                std::vector<std::uint32_t> each(photons.size());
                std::iota(each.begin(), each.end(), 0u);
                EXPECT_EQ(at, each);
                const PhotonTree& shape = tree.shape();
                EXPECT_EQ(shape.inner_nodes() + 1, shape.leaves());
                std::uint64_t held = 0;
                for (std::uint32_t e = shape.inner_nodes(); e < shape.end(); ++e) {
                    EXPECT_TRUE(shape.records(e) >= 1 && shape.records(e) <= leaf);
                    held += shape.records(e);
                }
                EXPECT_EQ(held, photons.size());
                if (rule == SplitRule::median) {
                    EXPECT_EQ(shape.leaves(), (photons.size() + leaf - 1) / leaf) << "full leaves";
                }
            }
}

TEST(BucketKd, TheMedianTreeOfSevenIsTheOneDrawnByHand) {
    // Leaves of two: 0 1 | 2 3 | 4 5 | 6; four leaves, so two on each side.
    const BucketKd tree(photons_on_a_line({6, 0, 5, 1, 4, 2, 3}),
                        {.rule = SplitRule::median, .leaf_photons = 2, .radius = 0});
    EXPECT_THAT(tree.photon_at(), ElementsAre(1, 3, 5, 6, 2, 4, 0));
    EXPECT_THAT(tree.shape().leaf_begin(), ElementsAre(0, 2, 4, 6, 7));
    // Inner nodes 0, 1, 2; leaves 3 to 6.
    EXPECT_THAT(tree.shape().children(), ElementsAre(1, 2, 3, 4, 5, 6));
    EXPECT_EQ(tree.shape().level(0), 0u);
    EXPECT_EQ(tree.shape().level(2), 1u);
    EXPECT_EQ(tree.shape().level(6), 2u);
    // The nearest of 3.4 is photon 6 at 3, 0.16 away squared: root (split 4) lower, node 1 (split 2) upper:
    // leaf 4; its far child at 1.4 is not entered, the root's at 0.6: no. Bits 0 1 0 0.
    NearestSet found(1);
    Recorded search;
    nearest(tree, {3.4f, 0, 0}, found, search);
    EXPECT_EQ(search.recorder.finish(), 1u);
    EXPECT_EQ(search.recorder.bytes()[0], 0b0100'0000);
    EXPECT_THAT(search.visited, ElementsAre(0, 1, 4));
    EXPECT_EQ(found[0].node, 6u);
}

TEST(BucketKd, ACellIsFartherThanThePlaneBeforeIt) {
    // A photon a leaf; planes go through the first photon above them: x = 5, then y = 3 on the left and y = 4
    // on the right. From (0, 1), in squares: the left's upper leaf is 4 away, the right half 25, its upper
    // leaf 9 by its plane and 25 + 9 in truth.
    std::vector<Photon> photons(4);
    photons[1].position = {0, 3, 0};
    photons[2].position = {5, 0, 0};
    photons[3].position = {5, 4, 0};
    const auto visited = [&](bool bounds, float radius) {
        const BucketKd tree(photons,
                            {.rule = SplitRule::median, .leaf_photons = 1, .radius = 0, .bounds = bounds});
        NearestSet found(4, radius);
        Recorded search;
        nearest(tree, {0, 1, 0}, found, search);
        return search.visited;
    };
    // Elements: root 0, left 1, right 2, leaves 3 to 6. 5.5 squared is 30.25, 5.9 squared 34.81.
    EXPECT_THAT(visited(false, 5.5f), ElementsAre(0, 1, 3, 4, 2, 5, 6));
    EXPECT_THAT(visited(true, 5.5f), ElementsAre(0, 1, 3, 4, 2, 5));
    EXPECT_THAT(visited(true, 5.9f), ElementsAre(0, 1, 3, 4, 2, 5, 6));
    EXPECT_THAT(visited(true, 1.0f), ElementsAre(0, 1, 3));
}

/// Photons on a wall 20 away: no plane lies between, so by planes a search passes nothing over within 20
/// along x and y, and by cells what is farther than that in the wall.
TEST(BucketKd, FromAfarBoundsSpareTheCornersOfASquare) {
    std::vector<Photon> photons(64 * 64);
    for (std::size_t i = 0; i < photons.size(); ++i)
        photons[i].position = {static_cast<float>(i % 64), static_cast<float>(i / 64), 0};
    const auto leaves = [&](bool bounds) {
        const BucketKd tree(photons,
                            {.rule = SplitRule::median, .leaf_photons = 1, .radius = 0, .bounds = bounds});
        NearestSet found(4);
        Recorded search;
        nearest(tree, {31.4f, 31.4f, 20}, found, search);
        return std::count_if(search.visited.begin(), search.visited.end(),
                             [&](std::uint32_t e) { return e >= tree.shape().inner_nodes(); });
    };
    // Leaves are squares of side 1 between the photons. The fourth nearest is 400.72 away squared: 41 rows
    // and columns are within 20.02 of the eye, and 1345 squares.
    EXPECT_EQ(leaves(false), 41 * 41);
    EXPECT_EQ(leaves(true), 1345);
}

TEST(BucketKd, TheMidpointSlidesToTheNearestPhoton) {
    // The cell is 0 to 16: the middle, 8, has 0 1 2 3 below. Below 8 the middle is 4: all lie below, so the
    // plane slides to 3 and takes 3 alone above it.
    const BucketKd tree(photons_on_a_line({0, 1, 2, 3, 16}),
                        {.rule = SplitRule::midpoint, .leaf_photons = 3, .radius = 0});
    EXPECT_THAT(tree.shape().leaf_begin(), ElementsAre(0, 3, 4, 5));
    EXPECT_THAT(tree.shape().children(), ElementsAre(1, 4, 2, 3));
}

TEST(BucketKd, VoxelVolumeCutsEmptySpaceOff) {
    // 90 photons in 0 .. 0.9 and ten in 9 .. 9.9: by volume the first plane lies in the gap, at the median it
    // does not.
    std::vector<float> x;
    for (int i = 0; i < 90; ++i) x.push_back(static_cast<float>(i) * 0.01f);
    for (int i = 0; i < 10; ++i) x.push_back(9 + static_cast<float>(i) * 0.1f);
    const auto first_lower = [&](SplitRule rule) {
        const BucketKd tree(photons_on_a_line(x), {.rule = rule, .leaf_photons = 90, .radius = 0.1f});
        return tree.shape().records(tree.shape().inner_nodes());
    };
    EXPECT_EQ(first_lower(SplitRule::voxel_volume), 90u);
    EXPECT_EQ(BucketKd(photons_on_a_line(x), {.rule = SplitRule::median, .leaf_photons = 16, .radius = 0})
                  .shape()
                  .leaf_begin()[1],
              16u);
}

TEST(BucketKd, TheTreeDependsOnThePhotonsAlone) {
    const std::vector<Photon> photons = clustered_photons(30'000);
    for (const SplitRule rule : rules) {
        const BucketKd::Config config{.rule = rule, .leaf_photons = 8, .radius = 0.01f};
        const BucketKd on_all(photons, config);
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        const BucketKd on_one(photons, config);
        EXPECT_TRUE(on_all.shape().same_as(on_one.shape()));
        EXPECT_TRUE(std::equal(on_all.photon_at().begin(), on_all.photon_at().end(),
                               on_one.photon_at().begin(), on_one.photon_at().end()));
    }
}

TEST(BucketKd, ManySearchesWalksDecode) {
    const std::vector<Photon> photons = left_balanced(uniform_photons(20'000));
    Numbers numbers(5);
    std::vector<Vec3> points;
    for (int q = 0; q < 500; ++q) points.push_back({numbers.uniform(), numbers.uniform(), numbers.uniform()});
    points.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
    for (const auto& [rule, bounds] :
         {std::pair(SplitRule::median, false), std::pair(SplitRule::median, true),
          std::pair(SplitRule::midpoint, true), std::pair(SplitRule::voxel_volume, false)}) {
        const BucketKd tree(photons, {.rule = rule, .leaf_photons = 8, .radius = 0.05f, .bounds = bounds});
        const Recording walks = record_walks(tree, points, 50, infinity);
        const Recording heap = record_walks(PhotonKd(photons), points, 50, infinity);
        EXPECT_EQ(walks.found_photons, heap.found_photons);
        EXPECT_EQ(walks.walk_bytes.back(), 0u);
        const auto decoder = tree.shape().decoder();
        std::uint64_t visited = 0, start = 0;
        for (const std::uint32_t bytes : walks.walk_bytes) {
            const auto [fault, elements] = decoder->decode(std::span(walks.walks).subspan(start, bytes));
            ASSERT_EQ(fault, WalkFault::none);
            visited += elements.size();
            start += bytes;
        }
        EXPECT_EQ(visited, walks.visited_nodes);
    }
}

TEST(BucketKd, DamagedWalksAreToldApart) {
    const std::vector<Photon> photons = uniform_photons(1000);
    const BucketKd tree(photons, {.rule = SplitRule::midpoint, .leaf_photons = 4, .radius = 0});
    NearestSet found(10);
    WalkRecorder recorder;
    nearest(tree, {0.3f, 0.6f, 0.1f}, found, recorder);
    recorder.finish();
    std::vector<std::uint8_t> walk(recorder.bytes().begin(), recorder.bytes().end());
    const auto decoder = tree.shape().decoder();
    EXPECT_EQ(decoder->decode(walk).fault, WalkFault::none);
    EXPECT_EQ(decoder->decode(std::span(walk).first(walk.size() - 1)).fault, WalkFault::ends_early);
    walk.push_back(0);
    EXPECT_EQ(decoder->decode(walk).fault, WalkFault::bytes_left_over);
    EXPECT_EQ(BucketKd({}, {}).shape().decoder()->decode(walk).fault, WalkFault::bytes_left_over);
    ASSERT_TRUE(rc::check([&] {
        const auto bytes = *rc::gen::arbitrary<std::vector<std::uint8_t>>();
        for (const std::uint32_t e : decoder->decode(bytes).elements) RC_ASSERT(e < tree.shape().end());
    }));
}

TEST(BucketKd, APhotonNowhereIsRefused) {
    std::vector<Photon> photons = uniform_photons(10);
    photons[3].position.y = infinity;
    EXPECT_THROW(BucketKd(photons, {}), trace::DataError);
}

}  // namespace
}  // namespace regather::spatial
