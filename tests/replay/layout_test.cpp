// Every way to replay, on layouts with gaps, with nodes of several lines, and with a base: against the lines
// of the same searches, found by searching again. Samples of sets are in set_sample_test.cpp.
#include "replay/layout.h"

#include <gtest/gtest.h>

#include <set>

#include "cachesim/policies/policy_sweep.h"
#include "replay/buffered.h"
#include "replay/detail.h"
#include "replay/levels.h"
#include "replay/pixel_traffic.h"
#include "replay/replay.h"
#include "tests/replay/traced.h"

namespace regather::replay {
namespace {

using cachesim::CacheConfig;
using cachesim::CacheStats;

const std::vector<CacheConfig> caches{
    {4096, 64, 4}, {2048, 32, 1}, {1024, 16, 32}, {4096, 64, cachesim::fully_associative}, {64 * 40, 64, 40}};

class OnLayout : public testing::TestWithParam<Placed> {
protected:
    std::vector<std::uint64_t> lines(const CacheConfig& cache) const {
        return searched.lines_of(order, cache.line_bytes, GetParam());
    }
    CacheStats expected(const CacheConfig& cache) const {
        const std::uint64_t all = cache.size_bytes / cache.line_bytes;
        ListedLru list(cache.sets(), cache.ways == cachesim::fully_associative ? all : cache.ways);
        CacheStats stats;
        for (const std::uint64_t line : lines(cache)) {
            ++stats.accesses;
            stats.misses += list.misses(line) ? 1 : 0;
        }
        return stats;
    }

    const Searched searched{2000, 150, 12};
    const WalkStore walks = searched.walks();
    const Layout layout = searched.layout(GetParam());
    const std::vector<std::uint32_t> order = shuffled_queries(150, 5);
};

INSTANTIATE_TEST_SUITE_P(Layouts, OnLayout,
                         testing::Values(Placed{"tight", 0, 20, 20}, Placed{"gaps", 0, 24, 20},
                                         Placed{"hot", 8, 32, 12}, Placed{"wide", 4100, 80, 75},
                                         Placed{"overlapping", 72, 20, 33},
                                         Placed{"scattered", 4099, 0, 0, true}),
                         [](const auto& layout) { return std::string(layout.param.name); });

TEST_P(OnLayout, Replay) {
    const ReplayConfig config{caches, false};
    const Replayed found = replay(walks, layout, order, config, count_revisits(walks, layout, config));
    for (std::size_t c = 0; c < caches.size(); ++c) {
        EXPECT_EQ(found.caches[c].accesses, expected(caches[c]).accesses) << c;
        EXPECT_EQ(found.caches[c].misses, expected(caches[c]).misses) << c;
        EXPECT_EQ(found.caches[c].traffic_bytes, expected(caches[c]).misses * caches[c].line_bytes) << c;
    }
    std::uint64_t raw = 0;
    for (const std::uint32_t query : order)
        for (const std::uint64_t node : searched.nodes_of(query)) raw += GetParam().at(node).bytes;
    EXPECT_EQ(found.raw_bytes, raw);
}

TEST_P(OnLayout, Compulsory) {
    for (const std::uint32_t line_bytes : {16u, 64u, 256u}) {
        const auto all = searched.lines_of(order, line_bytes, GetParam());
        EXPECT_EQ(compulsory_bytes(touched_elements(walks), layout, line_bytes),
                  std::set<std::uint64_t>(all.begin(), all.end()).size() * line_bytes);
    }
}

TEST_P(OnLayout, OptLiesBetweenTheFloorAndWhatIsMeasured) {
    for (const CacheConfig& cache : caches) {
        const cachesim::PolicyConfig best[] = {{cache, cachesim::Policy::opt}};
        cachesim::PolicySweep sweep(best);
        for (const std::uint64_t line : lines(cache)) {
            const cachesim::ByteAccess read{line * cache.line_bytes, 1, cachesim::Access::read};
            sweep.access({&read, 1});
        }
        const std::uint64_t opt = sweep.finish([](auto, auto) {})[0].stats.misses;
        const ReplayConfig config{{cache}, false};
        const Replayed found = replay(walks, layout, order, config, count_revisits(walks, layout, config));
        EXPECT_LE(compulsory_bytes(touched_elements(walks), layout, cache.line_bytes),
                  opt * cache.line_bytes);
        EXPECT_LE(opt, found.caches[0].misses);
        if (cache.ways > 1) {
            EXPECT_LT(opt, found.caches[0].misses);
        }
    }
}

TEST_P(OnLayout, Detail) {
    for (const CacheConfig& cache : caches) {
        const Detail detail = replay_in_detail(walks, layout, order, {}, {cache, 7});
        EXPECT_EQ(detail.sum().accesses, expected(cache).accesses);
        EXPECT_EQ(detail.sum().misses, expected(cache).misses);
        std::uint64_t accesses = 0, misses = 0;
        for (const DetailSlice& slice : detail.slices) accesses += slice.accesses, misses += slice.misses;
        EXPECT_EQ(accesses, expected(cache).accesses);
        EXPECT_EQ(misses, expected(cache).misses);
    }
    // In a cache that holds everything the bytes used are those that any search reads.
    std::set<std::uint64_t> bytes;
    for (const std::uint32_t query : order)
        for (const std::uint64_t node : searched.nodes_of(query))
            for (std::uint64_t b = 0; b < GetParam().at(node).bytes; ++b)
                bytes.insert(GetParam().at(node).address + b);
    const Detail all = replay_in_detail(walks, layout, order, {}, {{1 << 20, 64, 0}, 1});
    EXPECT_EQ(all.sum().used_bytes, bytes.size());
}

/// With nothing between the searches, and with records between them at a distance: the photons' accesses are
/// theirs.
TEST_P(OnLayout, Buffered) {
    const std::vector<BufferedTraffic> alone = replay_with_buffers(walks, layout, order, {}, caches);
    for (std::size_t c = 0; c < caches.size(); ++c) {
        EXPECT_EQ(alone[c].photons, expected(caches[c])) << c;
        EXPECT_EQ(alone[c].buffers, CacheStats{}) << c;
    }
    reorder::BufferUse use;
    use.batches = reorder::SortedBatches{.record_bytes = 24, .rounds = 1, .ends = {150}};
    for (const BufferedTraffic& traffic : replay_with_buffers(walks, layout, order, use, caches)) {
        EXPECT_EQ(traffic.photons.accesses, expected(traffic.config).accesses);
        EXPECT_GE(traffic.photons.misses, expected(traffic.config).misses);
        EXPECT_GT(traffic.buffers.misses, 0u);
    }
    // A cache for all of it: nobody takes another's place, and no line is both photons' and buffers'.
    const std::vector<CacheConfig> everything{{1 << 20, 64, 0}};
    const BufferedTraffic together = replay_with_buffers(walks, layout, order, use, everything)[0];
    EXPECT_EQ(together.photons, expected(everything[0]));
    EXPECT_EQ(together.buffers.misses, (150u * 24 + 63) / 64);
}

TEST_P(OnLayout, Levels) {
    for (const CacheConfig& cache : caches) {
        cachesim::LevelConfig level;
        level.cache.geometry = cache;
        std::vector<cachesim::Hierarchy> systems;
        systems.emplace_back(std::span(&level, 1));
        replay_levels(walks, layout, order, systems);
        const cachesim::LevelStats& stats = systems[0].stats(0, trace::Region::photons);
        EXPECT_EQ(stats.accesses, expected(cache).accesses);
        EXPECT_EQ(stats.misses, expected(cache).misses);
    }
}

TEST_P(OnLayout, PixelTraffic) {
    std::vector<std::uint32_t> pixels(order.size());
    for (std::size_t q = 0; q < pixels.size(); ++q) pixels[q] = static_cast<std::uint32_t>(q * q % 9);
    for (const CacheConfig& cache : caches) {
        std::vector<std::uint64_t> bytes(9);
        const std::uint64_t all = cache.size_bytes / cache.line_bytes;
        ListedLru list(cache.sets(), cache.ways == cachesim::fully_associative ? all : cache.ways);
        for (const std::uint32_t query : order)
            for (const std::uint64_t line : searched.lines_of(query, cache.line_bytes, GetParam()))
                bytes[pixels[query]] += list.misses(line) ? cache.line_bytes : 0;
        EXPECT_EQ(pixel_traffic(walks, layout, order, pixels, 9, cache), bytes);
    }
}

}  // namespace
}  // namespace regather::replay
