// Walks that tell which photons were found: they decode to the visits, then to those photons.
#include "spatial/photons/found_walk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <limits>

#include "spatial/photons/bucket_kd.h"
#include "spatial/photons/left_balanced.h"
#include "spatial/photons/recording.h"
#include "tests/spatial/photons.h"

namespace regather::spatial {
namespace {

using testing::ElementsAre;
using trace::Region;

std::vector<std::uint32_t> found_of(const auto& tree, Vec3 point, std::uint32_t k, float radius) {
    NearestSet found(k, radius);
    nearest(tree, point, found);
    std::vector<std::uint32_t> photons;
    for (std::size_t i = 0; i < found.size(); ++i) photons.push_back(found[i].node);
    std::sort(photons.begin(), photons.end());
    return photons;
}

/// A walk that tells nothing of the photons found is the front of one that does; behind its visits come the
/// photons that a search finds.
void expect_the_same(const auto& tree, const std::shared_ptr<const Structure>& shape, auto photon_of,
                     std::span<const Vec3> points, std::uint32_t k, float radius) {
    const WithFound with(shape, "with");
    const Recording plain = record_walks(tree, points, k, radius),
                    telling = record_walks(tree, points, k, radius, {.found = true});
    const auto plain_decoder = shape->decoder(), decoder = with.decoder();
    std::span<const std::uint8_t> plain_walks = plain.walks, walks = telling.walks;
    std::uint64_t visited = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto visits = plain_decoder->decode(plain_walks.first(plain.walk_bytes[i])).elements;
        const auto [fault, elements] = decoder->decode(walks.first(telling.walk_bytes[i]));
        plain_walks = plain_walks.subspan(plain.walk_bytes[i]);
        walks = walks.subspan(telling.walk_bytes[i]);
        RC_ASSERT(fault == WalkFault::none);
        RC_ASSERT(elements.size() >= visits.size());
        RC_ASSERT(std::equal(visits.begin(), visits.end(), elements.begin()));
        std::vector<std::uint32_t> found;
        for (const std::uint32_t e : elements.subspan(visits.size()))
            found.push_back(photon_of(e - with.range_of(Region::photon_power).first));
        std::sort(found.begin(), found.end());
        RC_ASSERT(found == found_of(tree, points[i], k, radius));
        visited += elements.size();
    }
    RC_ASSERT(walks.empty());
    RC_ASSERT(telling.visited_nodes == visited);
    RC_ASSERT(telling.found_photons == plain.found_photons);
}

TEST(FoundWalk, TellsThePhotonsThatTheSearchFindsBehindItsVisits) {
    ASSERT_TRUE(rc::check([] {
        const std::vector<Photon> photons = *any_photons(200);
        const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-4, 12)) * 0.5f; };
        std::vector<Vec3> points;
        for (int i = 0; i < 3; ++i) points.push_back({coordinate(), coordinate(), coordinate()});
        points.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
        const auto k = *rc::gen::inRange<std::uint32_t>(0, 30);
        const float radius = *rc::gen::element(std::numeric_limits<float>::infinity(), 1.0f, 0.0f);

        const std::vector<Photon> heap = left_balanced(photons);
        expect_the_same(
            PhotonKd(heap), std::make_shared<LeftBalanced>(static_cast<std::uint32_t>(heap.size())),
            [](std::uint32_t record) { return record; }, points, k, radius);
        const BucketKd buckets(photons, {.rule = SplitRule::median,
                                         .leaf_photons = *rc::gen::inRange<std::uint32_t>(1, 65),
                                         .radius = 0});
        expect_the_same(
            buckets, buckets.share_shape(), [&](std::uint32_t record) { return buckets.photon_at()[record]; },
            points, k, radius);
    }));
}

TEST(FoundWalk, OfFiveOnALineIsTheOneDrawnByHand) {
    // The heap of 0 .. 4 is 3 1 4 0 2. Of 0.9 the two nearest are 1 and 0: root 3, lower to 1, lower to 0,
    // then 2 over the plane of 1 at 0.01 squared, not 4 behind that of 3: near 0 0, far 1 0. Found: the
    // second and the third of four.
    const std::vector<Photon> heap = left_balanced(photons_on_a_line({0, 1, 2, 3, 4}));
    const std::vector<Vec3> point{{0.9f, 0, 0}};
    const Recording walk = record_walks(PhotonKd(heap), point, 2, 10, {.found = true});
    EXPECT_THAT(walk.walks, ElementsAre(0b0010'0000, 0b0110'0000));
    EXPECT_EQ(walk.visited_nodes, 6u);
    const WithFound structure(std::make_shared<LeftBalanced>(5), "left-balanced-kd:found=1");
    EXPECT_EQ(structure.end(), 11u);
    EXPECT_EQ(structure.range_of(Region::photon_power), (ElementRange{Region::photon_power, 6, 5}));
    EXPECT_THAT(structure.decoder()->decode(walk.walks).elements, ElementsAre(1, 2, 4, 5, 7, 9));
    EXPECT_EQ(structure.level(7), 1u) << "of node 2";
    EXPECT_EQ(structure.level(10), 2u) << "of node 5";
}

TEST(FoundWalk, WhatIsTooShortOrTooLongIsTold) {
    const std::vector<Photon> photons = uniform_photons(300);
    const BucketKd tree(photons, {.rule = SplitRule::midpoint, .leaf_photons = 60, .radius = 0});
    const WithFound structure(tree.share_shape(), "with");
    const std::vector<Vec3> point{{0.4f, 0.5f, 0.6f}};
    std::vector<std::uint8_t> walk = record_walks(tree, point, 20, 9, {.found = true}).walks;
    const auto decoder = structure.decoder();
    EXPECT_EQ(decoder->decode(walk).fault, WalkFault::none);
    EXPECT_EQ(decoder->decode(std::span(walk).first(walk.size() - 1)).fault, WalkFault::ends_early);
    walk.push_back(0);
    EXPECT_EQ(decoder->decode(walk).fault, WalkFault::bytes_left_over);
    EXPECT_EQ(decoder->decode({}).fault, WalkFault::none);
    EXPECT_TRUE(decoder->decode({}).elements.empty());
}

TEST(FoundWalk, WithoutPhotonsThereIsNothingToTell) {
    const WithFound structure(std::make_shared<LeftBalanced>(0), "with");
    EXPECT_EQ(structure.end(), 0u);
    EXPECT_TRUE(structure.decoder()->decode({}).elements.empty());
    EXPECT_EQ(structure.decoder()->decode(std::vector<std::uint8_t>{0}).fault, WalkFault::bytes_left_over);
}

}  // namespace
}  // namespace regather::spatial
