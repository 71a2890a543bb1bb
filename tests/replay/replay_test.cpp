#include "replay/replay.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <list>
#include <numeric>
#include <set>

#include "spatial/nearest.h"
#include "spatial/recording.h"
#include "tests/spatial/photons.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

using spatial::Numbers;
using trace::Vec3;

struct Traced {
    std::vector<trace::Photon> heap;
    std::vector<Vec3> points;
    spatial::Recording recording;

    Traced(std::size_t photons, std::size_t queries, std::uint32_t k)
        : heap(spatial::left_balanced(spatial::uniform_photons(photons))) {
        Numbers numbers(11);
        for (std::size_t q = 0; q < queries; ++q)
            points.push_back({numbers.uniform(), numbers.uniform(), numbers.uniform()});
        recording = spatial::record_walks(spatial::PhotonKd(heap), points, k, 1e9f);
    }
    WalkStore walks() const {
        return {static_cast<std::uint32_t>(heap.size()), recording.walk_bytes, recording.walks};
    }
    /// The lines of 128 bytes that searching in this order touches, one by one.
    std::vector<std::uint64_t> searched_lines(std::span<const std::uint32_t> order, std::uint32_t k,
                                              std::uint64_t line_bytes) const {
        struct Touch {
            std::vector<std::uint64_t> lines;
            std::uint64_t line_bytes;
            void visit(std::uint32_t node) {
                const std::uint64_t first = node * 20 / line_bytes, last = (node * 20 + 19) / line_bytes;
                for (std::uint64_t line = first; line <= last; ++line) lines.push_back(line);
            }
            void near(bool) {}
            void far(bool) {}
        } touch{{}, line_bytes};
        spatial::NearestSet found(k);
        for (const std::uint32_t q : order) spatial::nearest(spatial::PhotonKd(heap), points[q], found, touch);
        return touch.lines;
    }
};

/// LRU by its definition: a list of lines, the last used first.
std::uint64_t misses_of_a_list(std::span<const std::uint64_t> lines, std::uint64_t sets, std::size_t ways) {
    std::vector<std::list<std::uint64_t>> held(sets);
    std::uint64_t misses = 0;
    for (const std::uint64_t line : lines) {
        std::list<std::uint64_t>& set = held[line % sets];
        const auto found = std::find(set.begin(), set.end(), line);
        if (found != set.end()) {
            set.erase(found);
        } else {
            ++misses;
            if (set.size() == ways) set.pop_back();
        }
        set.push_front(line);
    }
    return misses;
}

Replayed replay(const WalkStore& walks, const HeapLayout& layout, std::span<const std::uint32_t> order,
                std::span<const cachesim::CacheConfig> caches) {
    const ReplayConfig config{{caches.begin(), caches.end()}, false};
    return replay(walks, layout, order, config, count_revisits(walks, layout, config));
}

std::vector<std::uint32_t> shuffled(std::size_t count, std::uint64_t seed) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    Numbers numbers(seed);
    for (std::size_t i = count; i > 1; --i)
        std::swap(order[i - 1], order[static_cast<std::size_t>(numbers.uniform() * static_cast<float>(i))]);
    return order;
}

TEST(Replay, MissesAreThoseOfSearchingAgainInThatOrderThroughAListOfLines) {
    const Traced traced(3000, 300, 20);
    for (const std::uint64_t seed : {1u, 2u}) {
        const std::vector<std::uint32_t> order = shuffled(300, seed);
        for (const cachesim::CacheConfig& cache : {cachesim::CacheConfig{4096, 128, 8}, cachesim::CacheConfig{2048, 64, 1},
                                                   cachesim::CacheConfig{1024, 16, 4}, cachesim::CacheConfig{8192, 128, 0}}) {
            const auto lines = traced.searched_lines(order, 20, cache.line_bytes);
            const std::uint64_t sets = cache.sets();
            const std::size_t ways = cache.ways == 0 ? cache.size_bytes / cache.line_bytes : cache.ways;
            const Replayed replayed = replay(traced.walks(), {}, order, std::span(&cache, 1));
            EXPECT_EQ(replayed.caches[0].accesses, lines.size());
            EXPECT_EQ(replayed.caches[0].misses, misses_of_a_list(lines, sets, ways)) << cache.line_bytes;
            EXPECT_EQ(replayed.caches[0].traffic_bytes, replayed.caches[0].misses * cache.line_bytes);
        }
    }
}

TEST(Replay, NodesOfThreePhotonsOn64ByteLinesAreThoseDrawnByHand) {
    // Nodes 0, 1, 2 at bytes 0, 20, 40: all on line 0; a fourth at 60 straddles lines 0 and 1.
    const Traced three(3, 1, 3), four(4, 1, 4);
    const std::vector<std::uint32_t> order{0};
    const cachesim::CacheConfig cache{1024, 64, 2};
    EXPECT_EQ(replay(three.walks(), {}, order, std::span(&cache, 1)).caches[0].accesses, 3u);
    EXPECT_EQ(replay(three.walks(), {}, order, std::span(&cache, 1)).caches[0].misses, 1u);
    EXPECT_EQ(replay(four.walks(), {}, order, std::span(&cache, 1)).caches[0].accesses, 5u);
    EXPECT_EQ(replay(four.walks(), {}, order, std::span(&cache, 1)).caches[0].misses, 2u);
    EXPECT_EQ(replay(four.walks(), {}, order, std::span(&cache, 1)).raw_bytes, 80u);
}

TEST(Replay, ACacheDoesNotKnowOfTheOthers) {
    const Traced traced(2000, 200, 10);
    const std::vector<std::uint32_t> order = shuffled(200, 4);
    const std::vector<cachesim::CacheConfig> caches{{4096, 128, 8}, {2048, 64, 2}, {16384, 128, 0}, {4096, 128, 1}};
    const Replayed together = replay(traced.walks(), {}, order, caches);
    for (std::size_t i = 0; i < caches.size(); ++i)
        EXPECT_EQ(replay(traced.walks(), {}, order, std::span(caches).subspan(i, 1)).caches[0].misses,
                  together.caches[i].misses);
}

TEST(Replay, WhatIsAskedForDoesNotDependOnTheOrderAndCompulsoryTrafficIsTheFloor) {
    const Traced traced(2000, 400, 10);
    const cachesim::CacheConfig cache{4096, 128, 8};
    const std::vector<bool> touched = touched_nodes(traced.walks());
    const std::uint64_t floor = compulsory_bytes(touched, {}, 128);
    std::set<std::uint64_t> accesses;
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        const Replayed replayed = replay(traced.walks(), {}, shuffled(400, seed), std::span(&cache, 1));
        accesses.insert(replayed.caches[0].accesses);
        EXPECT_EQ(replayed.visited_nodes, traced.recording.visited_nodes);
        EXPECT_GE(replayed.caches[0].traffic_bytes, floor);
    }
    EXPECT_EQ(accesses.size(), 1u);
    const auto lines = traced.searched_lines(shuffled(400, 1), 10, 128);
    EXPECT_EQ(floor, std::set<std::uint64_t>(lines.begin(), lines.end()).size() * 128);
    const cachesim::CacheConfig everything{1 << 20, 128, 0};
    EXPECT_EQ(replay(traced.walks(), {}, shuffled(400, 1), std::span(&everything, 1)).caches[0].traffic_bytes, floor);
}

TEST(Replay, MoreWaysAtEqualSetsNeverMissMore) {
    const Traced traced(5000, 300, 30);
    std::uint64_t before = ~std::uint64_t{0};
    for (const std::uint32_t ways : {1u, 2u, 4u, 8u, 16u}) {
        const cachesim::CacheConfig cache{16 * ways * 128, 128, ways};
        const std::uint64_t misses = replay(traced.walks(), {}, shuffled(300, 1), std::span(&cache, 1)).caches[0].misses;
        EXPECT_LE(misses, before);
        before = misses;
    }
}

TEST(Replay, ADamagedWalkIsRefusedByTheQuerysNumber) {
    Traced traced(1000, 50, 10);
    std::uint64_t start = 0;
    for (int q = 0; q < 30; ++q) start += traced.recording.walk_bytes[static_cast<std::size_t>(q)];
    for (std::uint32_t b = 0; b < traced.recording.walk_bytes[30]; ++b) traced.recording.walks[start + b] = 0;
    const std::vector<std::uint32_t> order = shuffled(50, 1);
    try {
        replay(traced.walks(), {}, order, {});
        FAIL();
    } catch (const trace::DataError& error) {
        EXPECT_NE(std::string(error.what()).find("query 30"), std::string::npos) << error.what();
    }
    traced.recording.walks.pop_back();
    EXPECT_THROW(traced.walks(), trace::DataError);
}

TEST(Replay, NoQueriesNoTraffic) {
    const Traced traced(10, 0, 3);
    const cachesim::CacheConfig cache{};
    EXPECT_EQ(replay(traced.walks(), {}, {}, std::span(&cache, 1)).caches[0].traffic_bytes, 0u);
    EXPECT_EQ(compulsory_bytes(touched_nodes(traced.walks()), {}, 128), 0u);
}

}  // namespace
}  // namespace regather::replay
