// Block hashing: blocks along the curve, buckets that name them, and what a search finds of the truth.
#include "spatial/photons/block_hashing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "spatial/curve.h"
#include "spatial/photons/recall.h"
#include "spatial/photons/structures.h"
#include "tests/spatial/brute_force.h"
#include "tests/spatial/photons.h"
#include "tests/spatial/recorded_visits.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

using testing::ElementsAre;
using trace::Region;

/// Photons whose coordinates no threshold of the table lies between.
bool share_a_bucket(const BlockHashing& hashing, std::uint32_t table, Vec3 a, Vec3 b) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float plane : hashing.thresholds(table, axis))
            if ((a[axis] < plane) != (b[axis] < plane)) return false;
    return true;
}

/// The blocks that a search looks at, by the thresholds and the photons of the blocks alone.
std::vector<std::uint32_t> slow_blocks(const BlockHashing& hashing, std::span<const Photon> photons,
                                       Vec3 point, std::size_t most) {
    const auto place = hashing.parts().photon_at();
    const auto begin = hashing.parts().begin();
    std::map<std::uint32_t, std::uint32_t> tables_of;
    for (std::uint32_t table = 0; table < hashing.tables(); ++table) {
        std::map<std::uint32_t, std::uint32_t> photons_of;
        for (std::uint32_t block = 0; block < hashing.parts().count(); ++block)
            for (std::uint32_t at = begin[block]; at < begin[block + 1]; ++at)
                if (share_a_bucket(hashing, table, photons[place[at]].position, point)) ++photons_of[block];
        std::vector<std::pair<std::uint32_t, std::uint32_t>> all(photons_of.begin(), photons_of.end());
        std::stable_sort(all.begin(), all.end(), [](auto a, auto b) { return a.second > b.second; });
        for (std::size_t i = 0; i < std::min<std::size_t>(16, all.size()); ++i) ++tables_of[all[i].first];
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> all(tables_of.begin(), tables_of.end());
    std::stable_sort(all.begin(), all.end(), [](auto a, auto b) { return a.second > b.second; });
    std::vector<std::uint32_t> blocks;
    for (const auto& [block, tables] : all) blocks.push_back(block);
    if (most > 0 && blocks.size() > most) blocks.resize(most);
    return blocks;
}

/// The nearest of the photons of some blocks.
std::vector<Neighbor> nearest_in(const BlockHashing& hashing, std::span<const Photon> photons,
                                 const std::vector<std::uint32_t>& blocks, Vec3 point, std::uint32_t k,
                                 float radius) {
    const std::set<std::uint32_t> looked(blocks.begin(), blocks.end());
    std::set<std::uint32_t> numbers;
    for (const std::uint32_t block : looked)
        for (std::uint32_t at = hashing.parts().begin()[block]; at < hashing.parts().begin()[block + 1]; ++at)
            numbers.insert(hashing.parts().photon_at()[at]);
    std::vector<Neighbor> all = brute_force(photons, point, photons.size(), radius);
    std::erase_if(all, [&](const Neighbor& n) { return !numbers.contains(n.node); });
    all.resize(std::min<std::size_t>(all.size(), k));
    return all;
}

std::vector<std::uint32_t> visits_of(const BlockHashing& hashing, Vec3 point) {
    NearestSet found(1);
    RecordedVisits search;
    nearest(hashing, point, found, search);
    return search.visited;
}

const std::vector<std::vector<Photon>>& clouds() {
    static const std::vector<std::vector<Photon>> all{uniform_photons(2000),
                                                      clustered_photons(2000),
                                                      coplanar_photons(2000),
                                                      duplicate_photons(2000),
                                                      std::vector<Photon>(500),
                                                      uniform_photons(1),
                                                      {}};
    return all;
}

TEST(BlockHashing, BlocksOnALineAreNamedAsDrawnByHand) {
    // Blocks of two along the curve, which comes back along x from the middle on: 0 1 | 2 9 | 7 6 | 5. Two
    // parts an axis, so one threshold: a coordinate of the photons; along y and z it is 0, and all photons
    // lie behind it.
    const std::vector<Photon> photons = photons_on_a_line({5, 9, 1, 7, 0, 2, 6});
    const BlockHashing hashing(photons, {.tables = 1, .block = 2});
    const auto at = hashing.parts().photon_at(), begin = hashing.parts().begin();
    EXPECT_THAT(std::vector<std::uint32_t>(at.begin(), at.end()), ElementsAre(4, 2, 5, 1, 3, 6, 0));
    EXPECT_THAT(std::vector<std::uint32_t>(begin.begin(), begin.end()), ElementsAre(0, 2, 4, 6, 7));
    ASSERT_EQ(hashing.buckets(), 8u);
    EXPECT_THAT(hashing.thresholds(0, 1), ElementsAre(0));
    ASSERT_THAT(hashing.thresholds(0, 0), ElementsAre(2));
    // Behind y = 0 and z = 0 buckets have numbers 6 (below x = 2) and 7, which has both of two blocks and one
    // of the last.
    EXPECT_THAT(hashing.named(6), ElementsAre(0));
    EXPECT_THAT(hashing.named(7), ElementsAre(1, 2, 3));
    EXPECT_TRUE(hashing.named(0).empty());
    const Listed& structure = *hashing.share_structure();
    EXPECT_THAT(structure.ranges(),
                ElementsAre(ElementRange{Region::directory, 0, 8}, ElementRange{Region::photons, 8, 4}));
    EXPECT_THAT(structure.elements().parent, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 6, 7, 7, 7));
    EXPECT_EQ(structure.node_bytes(), 64u);
    EXPECT_EQ(structure.records(11), 1u);
    // A search names the bucket, then its blocks by number: the one table counts each once.
    EXPECT_THAT(visits_of(hashing, {1.9f, 0, 0}), ElementsAre(6, 8));
    EXPECT_THAT(visits_of(hashing, {2, 0, 0}), ElementsAre(7, 9, 10, 11));
    EXPECT_THAT(visits_of(hashing, {2, -1, 0}), ElementsAre(5));
    // From 1.9 the two nearest are 2 and 1; 2 lies in a block that is not looked at, 0 is found in its place.
    NearestSet found(2);
    nearest(hashing, {1.9f, 0, 0}, found);
    EXPECT_EQ(found.nearest_first()[0].node, 2u);
    EXPECT_EQ(found.nearest_first()[1].node, 4u);
}

TEST(BlockHashing, SearchesFindWhatASlowModelFindsAndTheirWalksDecode) {
    ASSERT_TRUE(rc::check([] {
        const std::vector<Photon> photons = *any_photons(300);
        const BlockHashing::Config config{.tables = *rc::gen::inRange<std::uint32_t>(1, 9),
                                          .block = *rc::gen::inRange<std::uint32_t>(1, 7),
                                          .blocks = *rc::gen::element<std::uint32_t>(0, 1, 7)};
        const BlockHashing hashing(photons, config);
        const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-1, 24)) * 0.5f; };
        const auto k = *rc::gen::inRange<std::uint32_t>(1, 30);
        const float radius = *rc::gen::element(infinity, 2.0f, 0.0f);
        Vec3 point{coordinate(), coordinate(), coordinate()};
        if (!photons.empty() && *rc::gen::arbitrary<bool>())
            point = photons[*rc::gen::inRange<std::size_t>(0, photons.size())].position;
        const std::vector<std::uint32_t> blocks = slow_blocks(hashing, photons, point, config.blocks);
        NearestSet found(k, radius);
        RecordedVisits search;
        nearest(hashing, point, found, search);
        RC_ASSERT(same(found.nearest_first(), nearest_in(hashing, photons, blocks, point, k, radius)));
        search.recorder.finish();
        const auto decoder = hashing.share_structure()->decoder();
        const auto [fault, elements] = decoder->decode(search.recorder.bytes());
        RC_ASSERT(fault == WalkFault::none);
        RC_ASSERT(std::vector<std::uint32_t>(elements.begin(), elements.end()) == search.visited);
        if (photons.empty()) {
            RC_ASSERT(search.visited.empty());
            return;
        }
        // One bucket of each table, then the blocks in the model's order.
        RC_ASSERT(search.visited.size() == config.tables + blocks.size());
        for (std::uint32_t table = 0; table < config.tables; ++table)
            RC_ASSERT(search.visited[table] / hashing.buckets() == table);
        for (std::size_t i = 0; i < blocks.size(); ++i)
            RC_ASSERT(search.visited[config.tables + i] == config.tables * hashing.buckets() + blocks[i]);
    }));
}

TEST(BlockHashing, ABucketNamesSixteenBlocksAndNoMore) {
    // 100 blocks of one photon each at one place: they share every bucket.
    const std::vector<Photon> photons(100);
    const BlockHashing hashing(photons, {.tables = 3, .block = 1});
    std::vector<std::uint32_t> first(16);
    std::iota(first.begin(), first.end(), 0u);
    const auto named = hashing.named(hashing.bucket(2, {0, 0, 0}));
    EXPECT_EQ(std::vector<std::uint32_t>(named.begin(), named.end()), first);
    EXPECT_EQ(visits_of(hashing, {0, 0, 0}).size(), 3u + 16);
}

TEST(BlockHashing, BlocksFollowTheCurveAndHoldEveryPhotonOnce) {
    for (const std::vector<Photon>& photons : clouds()) {
        const BlockHashing hashing(photons, {.tables = 2, .block = 7});
        trace::Bounds3 box;
        for (const Photon& photon : photons) box.include(photon.position);
        const CellGrid cells(box, 1u << max_curve_bits);
        const auto code = [&](std::uint32_t photon) {
            return hilbert_code(morton_code(cells.cell_of(photons[photon].position)), max_curve_bits);
        };
        const auto at = hashing.parts().photon_at();
        EXPECT_TRUE(std::is_sorted(at.begin(), at.end(), [&](std::uint32_t a, std::uint32_t b) {
            return code(a) != code(b) ? code(a) < code(b) : a < b;
        }));
        EXPECT_EQ(std::set<std::uint32_t>(at.begin(), at.end()).size(), photons.size());
        EXPECT_EQ(hashing.parts().count(), (photons.size() + 6) / 7);
        const Listed& structure = *hashing.share_structure();
        std::vector<std::uint32_t> reached = structure.roots();
        for (std::size_t i = 0; i < reached.size(); ++i) structure.append_children(reached[i], reached);
        EXPECT_EQ(reached.size(), structure.end());
    }
}

TEST(BlockHashing, AThresholdLiesInItsPartOfThePhotonsAndTablesDiffer) {
    const std::vector<Photon> photons = clustered_photons(3000);
    const BlockHashing hashing(photons, {.tables = 5, .block = 3});  // 1000 blocks: 10 buckets an axis
    ASSERT_EQ(hashing.buckets(), 1000u);
    std::set<float> all;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<float> sorted;
        for (const Photon& photon : photons) sorted.push_back(photon.position[axis]);
        std::sort(sorted.begin(), sorted.end());
        for (std::uint32_t table = 0; table < 5; ++table) {
            const auto planes = hashing.thresholds(table, axis);
            ASSERT_EQ(planes.size(), 9u);
            for (std::size_t j = 0; j < 9; ++j) {
                EXPECT_GE(planes[j], sorted[3000 * j / 9]);
                EXPECT_LE(planes[j], sorted[3000 * (j + 1) / 9 - 1]);
                all.insert(planes[j]);
            }
        }
    }
    EXPECT_GT(all.size(), 120u);  // of 135; two tables seldom draw the same photon
}

TEST(BlockHashing, MoreTablesFindMore) {
    for (const std::vector<Photon>& cloud : clouds()) {
        const std::vector<Photon> heap = left_balanced(cloud);
        std::vector<Vec3> points;
        for (const Photon& photon : uniform_photons(100, 5)) points.push_back(photon.position);
        for (std::size_t i = 0; i < std::min<std::size_t>(100, heap.size()); ++i)
            points.push_back(heap[i].position);
        std::uint64_t before = 0;
        for (const std::uint32_t tables : {1u, 2u, 5u, 16u}) {
            const BlockHashing hashing(heap, {.tables = tables, .block = 8});
            const Recall recall = recall_of(hashing, heap, points, 10, 0.2f);
            std::uint64_t truth = 0;
            for (const Vec3 point : points) truth += brute_force(heap, point, 10, 0.2f).size();
            EXPECT_EQ(recall.nearest, truth);
            EXPECT_GE(recall.found, before);
            before = recall.found;
        }
        const BlockHashing few(heap, {.tables = 2, .block = 8}), more(heap, {.tables = 3, .block = 8});
        for (std::uint32_t table = 0; table < 2; ++table)
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_TRUE(std::ranges::equal(few.thresholds(table, axis), more.thresholds(table, axis)));
    }
}

TEST(BlockHashing, RecallIsTheShareOfTheTrueNearest) {
    const std::vector<Photon> heap = left_balanced(uniform_photons(1500));
    std::vector<Vec3> points;
    for (const Photon& photon : uniform_photons(300, 9)) points.push_back(photon.position);
    const BlockHashing hashing(heap, {.tables = 2, .block = 5, .blocks = 6});
    Recall expected;
    for (const Vec3 point : points) {
        const std::vector<Neighbor> truth = brute_force(heap, point, 12, 0.15f),
                                    found = nearest_in(hashing, heap, slow_blocks(hashing, heap, point, 6),
                                                       point, 12, 0.15f);
        expected.nearest += truth.size();
        for (const Neighbor& n : found)
            expected.found += static_cast<std::uint64_t>(std::count_if(
                truth.begin(), truth.end(), [&](const Neighbor& t) { return t.node == n.node; }));
    }
    EXPECT_EQ(recall_of(hashing, heap, points, 12, 0.15f), expected);
    EXPECT_LT(expected.share(), 0.9);
    EXPECT_GT(expected.share(), 0.3);
}

TEST(BlockHashing, OneBlockHasAll) {
    const std::vector<Photon> heap = left_balanced(uniform_photons(60));
    const BlockHashing hashing(heap, {.tables = 1, .block = 64});
    EXPECT_EQ(hashing.buckets(), 1u);
    const std::vector<Vec3> points{{0.5f, 0.25f, 0.125f}, {-7, 40, 3}, {infinity, 0, 0}};
    const Recall recall = recall_of(hashing, heap, points, 11, infinity);
    EXPECT_EQ(recall, (Recall{22, 22}));
    EXPECT_EQ(recall.share(), 1);
    EXPECT_EQ(Recall().share(), 1);
}

TEST(BlockHashing, WhatDoesNotFitIsRefused) {
    std::vector<Photon> photons = uniform_photons(100);
    NearestSet found(5);
    RecordedVisits search;
    nearest(BlockHashing(photons, {}), {0, infinity, 0}, found, search);
    EXPECT_EQ(found.size(), 0u);
    EXPECT_TRUE(search.visited.empty());
    photons[3].position.y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(BlockHashing(photons, {}), trace::DataError);
    EXPECT_THROW(parse_structure("block-hashing:blocks=1025"), trace::UsageError);
    EXPECT_THROW(parse_structure("block-hashing:tables=65"), trace::UsageError);
    EXPECT_EQ(parse_structure("block-hashing").text, "block-hashing:tables=16,block=16");
    EXPECT_EQ(parse_structure("block-hashing:blocks=9,tables=3").text,
              "block-hashing:tables=3,block=16,blocks=9");
    EXPECT_FALSE(parse_structure("block-hashing").entry->is_exact);
    EXPECT_TRUE(parse_structure("hashed-grid").entry->is_exact);
}

TEST(BlockHashing, RecallIsToldInCountsOrTakenOut) {
    trace::Json counts = trace::Json::object({{"photon_paths", 7u}});
    set_recall(counts, Recall{40, 30});
    EXPECT_EQ(counts,
              trace::Json::object({{"photon_paths", 7u}, {"nearest_photons", 40u}, {"nearest_found", 30u}}));
    EXPECT_EQ(text_of(Recall{40, 30}), ", recall 0.7500 of 40 nearest photons");
    set_recall(counts, std::nullopt);
    EXPECT_EQ(counts, trace::Json::object({{"photon_paths", 7u}}));
    EXPECT_EQ(text_of(std::nullopt), "");
}

}  // namespace
}  // namespace regather::spatial
