// Traces of one frame in turns through one hierarchy: drawn by hand, and against what one trace alone gives.
#include "replay/frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "replay/levels.h"
#include "spatial/rays/ray_tree.h"
#include "tests/replay/traced.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

using cachesim::Hierarchy, cachesim::HierarchyCounts, cachesim::LevelConfig, cachesim::LevelStats;
using testing::Pair;

LevelConfig level(std::uint64_t bytes, std::uint32_t line, std::uint32_t ways) {
    LevelConfig config;
    config.cache.geometry = {bytes, line, ways};
    return config;
}

LevelStats sum(const HierarchyCounts& counts, std::size_t at = 0) {
    LevelStats all;
    for (const LevelStats& region : counts.levels[at]) all += region;
    return all;
}

std::pair<std::uint64_t, std::uint64_t> accesses_and_misses(const HierarchyCounts& counts) {
    return {sum(counts).accesses, sum(counts).misses};
}

// Nodes 0 {1, 2}, 1 {3, 4}, 2 {5, 6}; leaves 3 to 6. An element fills a line of 64 bytes.
struct Drawn {
    std::shared_ptr<const spatial::RayTree> tree = std::make_shared<spatial::RayTree>(
        "seven",
        spatial::RayTree::Shape{.width = 2, .children = {1, 2, 3, 4, 5, 6}, .leaf_begin = {0, 1, 2, 3, 4}},
        spatial::RayTree::Stack{});
    Layout layout = Layout("lines", *tree, 0, 64, 64);
    std::vector<std::uint32_t> bytes, permutation, pixel;
    std::vector<std::uint8_t> walks;
    std::optional<WalkStore> store;

    // tests/spatial/rays/ray_walk_test.cpp draws these bits.
    void root(std::uint32_t at) { add(at, {0}); }                        // 0
    void three(std::uint32_t at) { add(at, {0b1001'0100}); }             // 0 1 4
    void six(std::uint32_t at) { add(at, {0b1001'0110, 0b1101'0000}); }  // 0 1 4 3 2 5
    FramePart part(std::uint64_t base, std::vector<std::uint32_t> order) {
        permutation = std::move(order);
        store.emplace(tree, bytes, walks);
        return {&*store, &layout, base, permutation, pixel};
    }

private:
    void add(std::uint32_t at, const std::vector<std::uint8_t>& walk) {
        bytes.push_back(static_cast<std::uint32_t>(walk.size()));
        walks.insert(walks.end(), walk.begin(), walk.end());
        pixel.push_back(at);
    }
};

/// By part, through one cache.
std::vector<HierarchyCounts> through(std::span<const FramePart> parts, std::optional<std::uint32_t> tile,
                                     const LevelConfig& cache) {
    std::vector<Hierarchy> systems;
    systems.emplace_back(std::span(&cache, 1));
    return replay_frame(parts, {.image_width = 4, .image_height = 1, .tile = tile}, systems)[0];
}

TEST(Frame, PartsTakeTurnsAsDrawnByHand) {
    Drawn a, b;
    a.root(0), a.three(3), a.six(1);
    b.three(2), b.root(0);
    const std::vector<FramePart> parts{a.part(0, {1, 2, 0}), b.part(7 * 64, {0, 1})};
    const LevelConfig two_lines = level(128, 64, 0);

    // Tiles of 2 pixels: a's 0 1 4 3 2 5, 0; b's 0. Then a's 0 1 4, whose 0 is still there; b's 0 1 4.
    const auto tiles = through(parts, 2, two_lines);
    EXPECT_THAT(accesses_and_misses(tiles[0]), Pair(10, 9));
    EXPECT_THAT(accesses_and_misses(tiles[1]), Pair(4, 4));
    const auto& regions = tiles[0].levels[0];
    EXPECT_EQ(regions[static_cast<std::size_t>(trace::Region::nodes)].accesses, 6u);
    EXPECT_EQ(regions[static_cast<std::size_t>(trace::Region::nodes)].misses, 5u);
    EXPECT_EQ(regions[static_cast<std::size_t>(trace::Region::triangles)].misses, 4u);
    EXPECT_EQ(sum(tiles[0]).bytes_in, 9u * 64);
    // Pixels: a's 0; b's 0; a's 0, which is still there, 1 4 3 2 5; b's 0 1 4; a's 0 1 4.
    const auto pixels = through(parts, 1, two_lines);
    EXPECT_THAT(accesses_and_misses(pixels[0]), Pair(10, 9));
    EXPECT_THAT(accesses_and_misses(pixels[1]), Pair(4, 4));
    // The whole image: a's 0 1 4, 0 1 4 3 2 5, 0, each anew; b's 0 1 4, 0.
    const auto image = through(parts, {}, two_lines);
    EXPECT_THAT(accesses_and_misses(image[0]), Pair(10, 10));
    EXPECT_THAT(accesses_and_misses(image[1]), Pair(4, 4));
    // Apart b's 0, 0 1 4 keeps its 0.
    EXPECT_THAT(accesses_and_misses(through(std::span(parts).subspan(1), 2, two_lines)[0]), Pair(4, 3));
    // In three lines the whole image finds its 0 1 4 again.
    const LevelConfig three_lines = level(192, 64, 0);
    EXPECT_THAT(accesses_and_misses(through(parts, 1, three_lines)[0]), Pair(10, 9));
    EXPECT_THAT(accesses_and_misses(through(parts, {}, three_lines)[0]), Pair(10, 7));
}

TEST(Frame, TracesOfOneMemoryServeEachOther) {
    Drawn a, b;
    a.six(0);
    b.three(0);
    const LevelConfig all = level(1024, 64, 0);
    const std::vector<FramePart> shared{a.part(0, {0}), b.part(0, {0})};
    EXPECT_THAT(accesses_and_misses(through(shared, 1, all)[1]), Pair(3, 0));
    const std::vector<FramePart> own{a.part(0, {0}), b.part(7 * 64, {0})};
    EXPECT_THAT(accesses_and_misses(through(own, 1, all)[1]), Pair(3, 3));
}

TEST(Frame, PartsThatShareNoSetAreAsTheyAreApart) {
    // Lines of a lie in sets 0 to 3 of 8, those of b in sets 4 to 7.
    const auto laid = [](const spatial::Structure& tree) {
        std::vector<Extent> extents(tree.end());
        for (std::uint32_t e = 0; e < extents.size(); ++e) extents[e] = {(e / 4 * 8 + e % 4) * 64, 60};
        return Layout("half", tree, std::move(extents));
    };
    const Searched searched(300, 400, 9), others(500, 350, 4);
    const WalkStore walks = searched.walks(), other_walks = others.walks();
    const Layout layout = laid(*searched.tree), other_layout = laid(*others.tree);
    const std::vector<std::uint32_t> order = shuffled_queries(400, 3), other_order = shuffled_queries(350, 4);
    std::vector<std::uint32_t> pixel(400);
    for (std::uint32_t q = 0; q < 400; ++q) pixel[q] = q * q % 4;
    const std::vector<FramePart> parts{{&walks, &layout, 0, order, pixel},
                                       {&other_walks, &other_layout, 4 * 64, other_order, pixel}};
    const LevelConfig cache = level(8 * 64 * 2, 64, 2);
    for (const std::optional<std::uint32_t> tile : {std::optional<std::uint32_t>(1), {2}, {}}) {
        const auto together = through(parts, tile, cache);
        for (std::size_t p = 0; p < parts.size(); ++p)
            EXPECT_EQ(together[p], through(std::span(parts).subspan(p, 1), tile, cache)[0]) << p;
    }
}

TEST(Frame, OneTraceAloneIsItsReplayThroughTheMachine) {
    const Searched searched(1000, 300, 8);
    const WalkStore walks = searched.walks();
    const Layout layout = searched.layout();
    const std::vector<std::uint32_t> order = shuffled_queries(300, 5);
    std::vector<std::uint32_t> pixel(300);
    for (std::uint32_t q = 0; q < 300; ++q) pixel[q] = q % 4;
    std::vector<LevelConfig> levels{level(1024, 64, 2), level(8192, 64, 4)};
    levels[0].prefetch = cachesim::Prefetch::tagged;
    levels[1].name = "L2";
    levels[1].inclusion = cachesim::Inclusion::exclusive;
    const cachesim::DramConfig dram{.banks = 2, .row_bytes = 256};
    std::vector<Hierarchy> expected, found;
    for (std::vector<Hierarchy>* systems : {&expected, &found}) systems->emplace_back(levels, dram);
    replay_levels(walks, layout, order, expected);
    expected[0].flush();
    const FramePart part{&walks, &layout, 0, order, pixel};
    const auto counts =
        replay_frame(std::span(&part, 1), {.image_width = 4, .image_height = 1, .tile = {}}, found);
    EXPECT_EQ(counts[0][0], expected[0].counts());
    EXPECT_GT(sum(counts[0][0], 1).clean_victims + sum(counts[0][0], 0).clean_victims, 0u);
    EXPECT_GT(counts[0][0].dram[static_cast<std::size_t>(trace::Region::photons)].row_conflicts, 0u);
    // In three parts the counts are shared out, not lost.
    std::vector<FramePart> parts;
    std::vector<Hierarchy> shared;
    shared.emplace_back(levels, dram);
    for (int p = 0; p < 3; ++p) parts.push_back({&walks, &layout, 0, order, pixel});
    const auto by_part = replay_frame(parts, {.image_width = 2, .image_height = 2, .tile = 1}, shared)[0];
    HierarchyCounts all = by_part[0];
    all += by_part[1];
    all += by_part[2];
    EXPECT_EQ(all, shared[0].counts());
    EXPECT_EQ(sum(by_part[0]).accesses, sum(by_part[2]).accesses);
    EXPECT_GT(sum(by_part[0]).misses, sum(by_part[1]).misses);  // which find the first one's photons
}

TEST(Frame, RefusesAPixelOutsideTheImage) {
    Drawn a;
    a.root(3), a.root(4);
    const std::vector<FramePart> parts{a.part(0, {0, 1})};
    try {
        through(parts, 1, level(128, 64, 0));
        FAIL();
    } catch (const trace::DataError& error) {
        EXPECT_STREQ(error.what(),
                     "walk.npy: query 1: found pixel 4, expected one below 4, as the image has");
    }
}

}  // namespace
}  // namespace regather::replay
