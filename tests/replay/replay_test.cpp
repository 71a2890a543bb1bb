#include "replay/replay.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <list>
#include <numeric>
#include <set>

#include "spatial/photons/nearest.h"
#include "spatial/photons/recording.h"
#include "tests/replay/traced.h"
#include "tests/spatial/photons.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

using spatial::Numbers;
using trace::Vec3;

std::uint64_t misses_of_a_list(std::span<const std::uint64_t> lines, std::uint64_t sets, std::size_t ways) {
    ListedLru list(sets, ways);
    return static_cast<std::uint64_t>(
        std::count_if(lines.begin(), lines.end(), [&](std::uint64_t line) { return list.misses(line); }));
}

Replayed replay(const WalkStore& walks, const Layout& layout, std::span<const std::uint32_t> order,
                std::span<const cachesim::CacheConfig> caches) {
    const ReplayConfig config{{caches.begin(), caches.end()}, false};
    return replay(walks, layout, order, config, count_revisits(walks, layout, config));
}

TEST(Replay, MissesAreThoseOfSearchingAgainInThatOrderThroughAListOfLines) {
    const Searched traced(3000, 300, 20);
    for (const std::uint64_t seed : {1u, 2u}) {
        const std::vector<std::uint32_t> order = shuffled_queries(300, seed);
        for (const cachesim::CacheConfig& cache :
             {cachesim::CacheConfig{4096, 128, 8}, cachesim::CacheConfig{2048, 64, 1},
              cachesim::CacheConfig{1024, 16, 4}, cachesim::CacheConfig{8192, 128, 0}}) {
            const auto lines = traced.lines_of(order, cache.line_bytes);
            const std::uint64_t sets = cache.sets();
            const std::size_t ways = cache.ways == 0 ? cache.size_bytes / cache.line_bytes : cache.ways;
            const Replayed replayed = replay(traced.walks(), traced.layout(), order, std::span(&cache, 1));
            EXPECT_EQ(replayed.caches[0].accesses, lines.size());
            EXPECT_EQ(replayed.caches[0].misses, misses_of_a_list(lines, sets, ways)) << cache.line_bytes;
            EXPECT_EQ(replayed.caches[0].traffic_bytes, replayed.caches[0].misses * cache.line_bytes);
        }
    }
}

TEST(Replay, NodesOfThreePhotonsOn64ByteLinesAreThoseDrawnByHand) {
    // Nodes 0, 1, 2 at bytes 0, 20, 40: all on line 0; a fourth at 60 straddles lines 0 and 1.
    const Searched three(3, 1, 3), four(4, 1, 4);
    const std::vector<std::uint32_t> order{0};
    const cachesim::CacheConfig cache{1024, 64, 2};
    EXPECT_EQ(replay(three.walks(), three.layout(), order, std::span(&cache, 1)).caches[0].accesses, 3u);
    EXPECT_EQ(replay(three.walks(), three.layout(), order, std::span(&cache, 1)).caches[0].misses, 1u);
    EXPECT_EQ(replay(four.walks(), four.layout(), order, std::span(&cache, 1)).caches[0].accesses, 5u);
    EXPECT_EQ(replay(four.walks(), four.layout(), order, std::span(&cache, 1)).caches[0].misses, 2u);
    EXPECT_EQ(replay(four.walks(), four.layout(), order, std::span(&cache, 1)).raw_bytes, 80u);
}

TEST(Replay, ACacheDoesNotKnowOfTheOthers) {
    const Searched traced(2000, 200, 10);
    const std::vector<std::uint32_t> order = shuffled_queries(200, 4);
    const std::vector<cachesim::CacheConfig> caches{
        {4096, 128, 8}, {2048, 64, 2}, {16384, 128, 0}, {4096, 128, 1}};
    const Replayed together = replay(traced.walks(), traced.layout(), order, caches);
    for (std::size_t i = 0; i < caches.size(); ++i)
        EXPECT_EQ(
            replay(traced.walks(), traced.layout(), order, std::span(caches).subspan(i, 1)).caches[0].misses,
            together.caches[i].misses);
}

TEST(Replay, WhatIsAskedForDoesNotDependOnTheOrderAndCompulsoryTrafficIsTheFloor) {
    const Searched traced(2000, 400, 10);
    const cachesim::CacheConfig cache{4096, 128, 8};
    const std::vector<bool> touched = touched_elements(traced.walks());
    const std::uint64_t floor = compulsory_bytes(touched, traced.layout(), 128);
    std::set<std::uint64_t> accesses;
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        const Replayed replayed =
            replay(traced.walks(), traced.layout(), shuffled_queries(400, seed), std::span(&cache, 1));
        accesses.insert(replayed.caches[0].accesses);
        EXPECT_EQ(replayed.visited_nodes, traced.recording.visited_nodes);
        EXPECT_GE(replayed.caches[0].traffic_bytes, floor);
    }
    EXPECT_EQ(accesses.size(), 1u);
    const auto lines = traced.lines_of(shuffled_queries(400, 1), 128);
    EXPECT_EQ(floor, std::set<std::uint64_t>(lines.begin(), lines.end()).size() * 128);
    const cachesim::CacheConfig everything{1 << 20, 128, 0};
    EXPECT_EQ(replay(traced.walks(), traced.layout(), shuffled_queries(400, 1), std::span(&everything, 1))
                  .caches[0]
                  .traffic_bytes,
              floor);
}

TEST(Replay, MoreWaysAtEqualSetsNeverMissMore) {
    const Searched traced(5000, 300, 30);
    std::uint64_t before = ~std::uint64_t{0};
    for (const std::uint32_t ways : {1u, 2u, 4u, 8u, 16u}) {
        const cachesim::CacheConfig cache{16 * ways * 128, 128, ways};
        const std::uint64_t misses =
            replay(traced.walks(), traced.layout(), shuffled_queries(300, 1), std::span(&cache, 1))
                .caches[0]
                .misses;
        EXPECT_LE(misses, before);
        before = misses;
    }
}

const std::vector<cachesim::CacheConfig> served{
    {4096, 128, 8},  {2048, 64, 2}, {2048, 128, 1},     {1024, 16, 32}, {65536, 64, 4}, {3072, 64, 3},
    {16384, 128, 0}, {3000, 8, 0},  {1 << 20, 128, 16}, {8192, 128, 4}, {64, 64, 1},    {512, 128, 1}};

TEST(Replay, ClassesAreHillsOfEveryAccess) {
    const Searched traced(3000, 150, 20);
    const std::vector<std::uint32_t> order = shuffled_queries(150, 3);
    const ReplayConfig config{served, true};
    const WalkStore walks = traced.walks();
    const Layout layout = traced.layout();
    const Replayed replayed = replay(walks, layout, order, config, count_revisits(walks, layout, config));
    for (std::size_t c = 0; c < served.size(); ++c) {
        const cachesim::CacheConfig& cache = served[c];
        const std::size_t size = cache.size_bytes / cache.line_bytes;
        ListedLru list(cache.sets(), cache.ways == 0 ? size : cache.ways), full(1, size);
        std::set<std::uint64_t> met;
        MissClasses expected;
        for (const std::uint64_t line : traced.lines_of(order, cache.line_bytes)) {
            const bool missed = list.misses(line), full_missed = full.misses(line),
                       first = met.insert(line).second;
            if (missed) ++(first ? expected.compulsory : full_missed ? expected.capacity : expected.conflict);
        }
        const CacheTraffic& traffic = replayed.caches[c];
        ASSERT_TRUE(traffic.classes);
        EXPECT_EQ(traffic.classes->compulsory, expected.compulsory) << c;
        EXPECT_EQ(traffic.classes->capacity, expected.capacity) << c;
        EXPECT_EQ(traffic.classes->conflict, expected.conflict) << c;
        EXPECT_EQ(traffic.classes->compulsory, met.size()) << c;
        EXPECT_EQ(traffic.classes->compulsory + traffic.classes->capacity + traffic.classes->conflict,
                  traffic.misses)
            << c;
        if (cache.ways == 0) {
            EXPECT_EQ(traffic.classes->conflict, 0u);
        }
        EXPECT_FALSE(traffic.error);
    }
}

TEST(Replay, ClassesDoNotChangeTheMisses) {
    const Searched traced(2000, 200, 10);
    const std::vector<std::uint32_t> order = shuffled_queries(200, 8);
    const WalkStore walks = traced.walks();
    const Layout layout = traced.layout();
    const ReplayConfig with{served, true}, without{served, false};
    const Replayed a = replay(walks, layout, order, with, count_revisits(walks, layout, with));
    const Replayed b = replay(walks, layout, order, without, count_revisits(walks, layout, without));
    for (std::size_t c = 0; c < served.size(); ++c) {
        EXPECT_EQ(a.caches[c].misses, b.caches[c].misses);
        EXPECT_EQ(a.caches[c].accesses, b.caches[c].accesses);
        EXPECT_FALSE(b.caches[c].classes);
    }
}

TEST(Replay, CachesOfMoreWaysThanAFamilyServesAgreeWithAList) {
    const Searched traced(3000, 150, 20);
    const std::vector<std::uint32_t> order = shuffled_queries(150, 3);
    const std::vector<cachesim::CacheConfig> caches{
        {4 * 40 * 128, 128, 40}, {2 * 33 * 64, 64, 33}, {33 * 128, 128, 33}, {4096, 128, 8}};
    EXPECT_FALSE(family_serves(caches[0]));
    EXPECT_TRUE(family_serves(caches[3]));
    EXPECT_TRUE(family_serves({4096, 128, 32}));
    EXPECT_TRUE(family_serves({4096, 128, 0}));
    const ReplayConfig config{caches, true};
    const WalkStore walks = traced.walks();
    const Layout layout = traced.layout();
    const Replayed replayed = replay(walks, layout, order, config, count_revisits(walks, layout, config));
    for (std::size_t c = 0; c < caches.size(); ++c) {
        const auto lines = traced.lines_of(order, caches[c].line_bytes);
        EXPECT_EQ(replayed.caches[c].accesses, lines.size());
        EXPECT_EQ(replayed.caches[c].misses, misses_of_a_list(lines, caches[c].sets(), caches[c].ways)) << c;
        EXPECT_EQ(replayed.caches[c].classes.has_value(), family_serves(caches[c]));
    }
    const ReplayConfig alone{{caches[0]}, false};
    EXPECT_TRUE(count_revisits(walks, layout, alone).empty());
    EXPECT_EQ(replay(walks, layout, order, alone, {}).caches[0].misses, replayed.caches[0].misses);
}

TEST(Replay, RevisitsOfMoreCachesServeFewer) {
    const Searched traced(2000, 200, 10);
    const std::vector<std::uint32_t> order = shuffled_queries(200, 5);
    const WalkStore walks = traced.walks();
    const Layout layout = traced.layout();
    const Revisits all = count_revisits(walks, layout, {served, true});
    for (const cachesim::CacheConfig& cache :
         {cachesim::CacheConfig{4096, 128, 8}, cachesim::CacheConfig{1024, 64, 1},
          cachesim::CacheConfig{128 * 16, 16, 0}}) {
        for (const bool classes : {false, true}) {
            const ReplayConfig config{{cache}, classes};
            EXPECT_TRUE(serve(all, config));
            const Replayed fewer = replay(walks, layout, order, config, all);
            const Replayed own = replay(walks, layout, order, config, count_revisits(walks, layout, config));
            EXPECT_EQ(fewer.caches[0].misses, own.caches[0].misses);
            EXPECT_EQ(fewer.caches[0].classes, own.caches[0].classes);
        }
    }
}

TEST(Replay, RevisitsOfOtherCachesDoNotServe) {
    const Searched searched(100, 10, 5);
    const WalkStore walks = searched.walks();
    const Layout layout = searched.layout();
    const std::vector<cachesim::CacheConfig> caches{{4096, 128, 8}, {2048, 64, 0}};
    const Revisits found = count_revisits(walks, layout, {caches, false});
    const auto serves = [&](const cachesim::CacheConfig& cache, bool classes) {
        return serve(found, ReplayConfig{.caches = {cache}, .classes = classes});
    };
    EXPECT_TRUE(serves({4096, 128, 8}, false));
    EXPECT_TRUE(serves({512, 128, 1}, false));          // 4 sets, too
    EXPECT_TRUE(serves({4 * 40 * 64, 64, 40}, false));  // simulated for itself
    EXPECT_FALSE(serves({4096, 128, 8}, true));         // no classes
    EXPECT_FALSE(serves({8192, 128, 16}, false));       // more ways
    EXPECT_FALSE(serves({8192, 128, 8}, false));        // other sets
    EXPECT_FALSE(serves({4096, 32, 0}, false));         // another line
    EXPECT_FALSE(serve({}, {.caches = caches, .classes = false}));
    EXPECT_TRUE(serve({}, {}));
}

TEST(Replay, RevisitsDoNotDependOnTheThreads) {
    // More than a range of 4096 queries for each of them.
    const Searched traced(300, 20'000, 3);
    const WalkStore walks = traced.walks();
    const Layout layout = traced.layout();
    const ReplayConfig config{served, true};
    const auto counted_by = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return count_revisits(walks, layout, config);
    };
    const Revisits one = counted_by(1);
    EXPECT_EQ(counted_by(2), one);
    EXPECT_EQ(counted_by(4), one);
    EXPECT_EQ(counted_by(2), one);
    EXPECT_EQ(one.size(), 4u);  // lines of 8, 16, 64 and 128 bytes
    for (const auto& [line_bytes, counts] : one) EXPECT_EQ(counts.compulsory, 0u);
}

TEST(Replay, ADamagedWalkIsRefusedByTheQuerysNumber) {
    Searched traced(1000, 50, 10);
    std::uint64_t start = 0;
    for (int q = 0; q < 30; ++q) start += traced.recording.walk_bytes[static_cast<std::size_t>(q)];
    for (std::uint32_t b = 0; b < traced.recording.walk_bytes[30]; ++b) traced.recording.walks[start + b] = 0;
    const std::vector<std::uint32_t> order = shuffled_queries(50, 1);
    try {
        replay(traced.walks(), traced.layout(), order, {});
        FAIL();
    } catch (const trace::DataError& error) {
        EXPECT_NE(std::string(error.what()).find("query 30"), std::string::npos) << error.what();
    }
    traced.recording.walks.pop_back();
    EXPECT_THROW(traced.walks(), trace::DataError);
}

TEST(Replay, NoQueriesNoTraffic) {
    const Searched traced(10, 0, 3);
    const cachesim::CacheConfig cache{};
    EXPECT_EQ(replay(traced.walks(), traced.layout(), {}, std::span(&cache, 1)).caches[0].traffic_bytes, 0u);
    EXPECT_EQ(compulsory_bytes(touched_elements(traced.walks()), traced.layout(), 128), 0u);
}

}  // namespace
}  // namespace regather::replay
