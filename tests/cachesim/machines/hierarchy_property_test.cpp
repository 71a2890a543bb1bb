// Hierarchies of any kind: what must hold for all of them, and what is known of some from elsewhere.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <set>

#include "tests/cachesim/machines/any_hierarchy.h"

namespace regather::cachesim {
namespace {

constexpr auto regions = {trace::Region::photons, trace::Region::reorder_buffer, trace::Region::other};

// ---- known from elsewhere ----

TEST(HierarchyProperties, OneLruLevelIsAnLruCache) {
    const bool equal = rc::check([] {
        LevelConfig level;
        const std::uint32_t ways = one_of({1u, 2u, 3u, 8u}), sets = one_of({1u, 2u, 4u});
        level.cache.geometry = {std::uint64_t{ways} * sets * 64, 64, ways};
        Hierarchy hierarchy({&level, 1}, small_dram);
        LruCache cache(level.cache.geometry);
        for (const Step& step : any_steps(300)) {
            run(hierarchy, step);
            for_each_line(step.access.address, step.access.bytes, 64, [&](Line line) {
                cache.access({&line, 1}, step.region, step.access.kind);
            });
        }
        hierarchy.flush();
        cache.flush();
        for (const trace::Region region : regions) {
            const LevelStats mine = hierarchy.stats(0, region);
            RC_ASSERT((CacheStats{mine.accesses, mine.misses, mine.writebacks}) == cache.stats(region));
        }
        RC_ASSERT(hierarchy.total(0).bytes_in + hierarchy.total(0).bytes_out == cache.traffic_bytes());
        const DramStats dram = hierarchy.dram()->total();
        RC_ASSERT(16 * (dram.bursts_read + dram.bursts_written) == cache.traffic_bytes());
    });
    ASSERT_TRUE(equal);
}

TEST(HierarchyProperties, ALevelBelowIsACacheThatSeesTheMissesOfTheLevelAbove) {
    const bool equal = rc::check([] {
        std::vector<LevelConfig> levels(3);
        std::vector<LruCache> caches;
        for (std::size_t i = 0; i < levels.size(); ++i) {
            levels[i].name = std::to_string(i);
            const std::uint32_t ways = one_of({1u, 2u, 5u}), sets = one_of({1u, 2u, 4u});
            levels[i].cache.geometry = {std::uint64_t{ways} * sets * 64, 64, ways};
            caches.emplace_back(levels[i].cache.geometry);
        }
        Hierarchy hierarchy(levels);
        for (Step step : any_steps(400)) {
            step.access.kind = Access::read;
            run(hierarchy, step);
            for_each_line(step.access.address, step.access.bytes, 64, [&](Line line) {
                for (LruCache& cache : caches) {
                    const std::uint64_t misses = cache.total().misses;
                    cache.access({&line, 1}, step.region);
                    if (cache.total().misses == misses) break;
                }
            });
        }
        for (std::size_t i = 0; i < levels.size(); ++i)
            for (const trace::Region region : regions) {
                const LevelStats mine = hierarchy.stats(i, region);
                RC_ASSERT((CacheStats{mine.accesses, mine.misses, mine.writebacks}) ==
                          caches[i].stats(region));
            }
    });
    ASSERT_TRUE(equal);
}

// What the levels hold together is the stack of LRU, cut at their sum: an exclusive level continues the one
// above, and so does a victim buffer.
TEST(HierarchyProperties, FullyAssociativeExclusiveLevelsAreOneLruCacheOfTheirSum) {
    const bool equal = rc::check([] {
        std::vector<LevelConfig> levels(one_of({1u, 2u, 3u}));
        std::uint32_t sum = 0;
        for (LevelConfig& level : levels) {
            const std::uint32_t ways = one_of({1u, 2u, 5u});
            level.name = std::to_string(sum);
            level.cache.geometry = {std::uint64_t{ways} * 64, 64, fully_associative};
            if (&level != levels.data()) level.inclusion = Inclusion::exclusive;
            sum += ways;
        }
        levels.back().victim_lines = one_of({0u, 2u, 4u});
        sum += levels.back().victim_lines;
        // Below the first level a hit in the buffer moves up; in the first it swaps: the same stack.
        Hierarchy hierarchy(levels, small_dram);
        LruCache cache({std::uint64_t{sum} * 64, 64, fully_associative});
        for (const Step& step : any_steps(300)) {
            run(hierarchy, step);
            for_each_line(step.access.address, step.access.bytes, 64, [&](Line line) {
                cache.access({&line, 1}, step.region, step.access.kind);
            });
        }
        RC_ASSERT(hierarchy.total(levels.size() - 1).misses == cache.total().misses);
        RC_ASSERT(hierarchy.total(levels.size() - 1).writebacks == cache.total().writebacks);
        hierarchy.flush();
        cache.flush();
        RC_ASSERT(16 * hierarchy.dram()->total().bursts_written == 64 * cache.total().writebacks);
    });
    ASSERT_TRUE(equal);
}

// ---- what must hold for all ----

void check_inclusion(const Hierarchy& hierarchy) {
    for (std::size_t level = 1; level < hierarchy.levels(); ++level)
        for (std::uint64_t number = 0; number < lines_asked + 4; ++number) {
            const Line line{number};
            const Inclusion inclusion = hierarchy.config(level).inclusion;
            if (inclusion == Inclusion::exclusive)
                RC_ASSERT(!(hierarchy.holds(level - 1, line) && hierarchy.holds(level, line)));
            if (inclusion == Inclusion::inclusive)
                for (std::size_t above = 0; above < level; ++above)
                    for (unsigned sector = 0; sector < 4; ++sector)
                        RC_ASSERT(!hierarchy.holds(above, line, sector) ||
                                  hierarchy.holds(level, line, sector));
        }
}

TEST(HierarchyProperties, InclusiveAndExclusiveHoldAfterEveryAccess) {
    const bool holds = rc::check([] {
        Hierarchy hierarchy(any_levels(one_of({2u, 3u, 4u})), small_dram);
        for (const Step& step : any_steps(150)) {
            run(hierarchy, step);
            check_inclusion(hierarchy);
        }
    });
    ASSERT_TRUE(holds);
}

TEST(HierarchyProperties, WhatWasReadIsInTheNearestLevelUnlessAPrefetchPushedItOut) {
    const bool holds = rc::check([] {
        std::vector<LevelConfig> levels = any_levels(3);
        for (LevelConfig& level : levels) level.prefetch = Prefetch::none;
        Hierarchy hierarchy(levels);
        for (const Step& step : any_steps(150)) {
            run(hierarchy, step);
            if (step.access.kind == Access::write) continue;
            const std::uint64_t last = step.access.address + step.access.bytes - 1;
            const auto sector = static_cast<unsigned>(last % 64 / levels[0].sector());
            RC_ASSERT(hierarchy.holds(0, Line{last / 64}, sector));
        }
    });
    ASSERT_TRUE(holds);
}

TEST(HierarchyProperties, CountsAddUp) {
    const bool holds = rc::check([] {
        const std::vector<LevelConfig> levels = any_levels(one_of({1u, 2u, 3u, 4u}));
        Hierarchy hierarchy(levels, small_dram);
        std::set<std::uint64_t> read, written;  // sectors
        std::uint64_t asked = 0;
        const std::uint64_t sector = levels[0].sector();
        for (const Step& step : any_steps(300)) {
            run(hierarchy, step);
            for_each_line(step.access.address, step.access.bytes, 64, [&](Line) { ++asked; });
            for_each_line(
                step.access.address, step.access.bytes, static_cast<std::uint32_t>(sector), [&](Line s) {
                    (step.access.kind == Access::read ? read : written).insert(static_cast<std::uint64_t>(s));
                });
        }
        hierarchy.flush();
        RC_ASSERT(hierarchy.total(0).accesses == asked);
        bool exact_bytes_pass = false;
        for (std::size_t i = 0; i < levels.size(); ++i) {
            exact_bytes_pass |= levels[i].cache.write == WritePolicy::through ||
                                levels[i].cache.write_miss == WriteMiss::no_allocate;
            for (const trace::Region region : regions) {
                const LevelStats& here = hierarchy.stats(i, region);
                RC_ASSERT(here.hits + here.misses == here.accesses);
                RC_ASSERT(here.sector_misses <= here.misses);
                RC_ASSERT(here.useful_prefetches <= here.prefetches);
                if (i + 1 < levels.size()) RC_ASSERT(hierarchy.stats(i + 1, region).accesses == here.misses);
            }
            RC_ASSERT(hierarchy.config(i).prefetch != Prefetch::none || hierarchy.total(i).prefetches == 0);
        }
        // Memory gives what the last level takes in, and gets at least every sector that was written.
        const DramStats dram = hierarchy.dram()->total();
        const LevelStats last = hierarchy.total(levels.size() - 1);
        RC_ASSERT(dram.bursts_read * 16 == last.bytes_in);
        RC_ASSERT(dram.bursts_read * 16 >= read.size() * sector);
        RC_ASSERT(dram.row_hits + dram.row_empty + dram.row_conflicts ==
                  dram.bursts_read + dram.bursts_written);
        RC_ASSERT(exact_bytes_pass || dram.bursts_written * 16 == last.bytes_out);
        RC_ASSERT(exact_bytes_pass || last.bytes_out >= written.size() * sector);
    });
    ASSERT_TRUE(holds);
}

// Flushing twice, or accessing in other batches, changes nothing.
TEST(HierarchyProperties, BatchesDoNotMatter) {
    const bool holds = rc::check([] {
        const std::vector<LevelConfig> levels = any_levels(2);
        Hierarchy one(levels, small_dram), many(levels, small_dram);
        std::vector<ByteAccess> batch;
        for (const Step& step : any_steps(200)) {
            batch.push_back(step.access);
            many.access({&step.access, 1}, trace::Region::photons);
        }
        one.access(batch, trace::Region::photons);
        one.flush();
        many.flush();
        many.flush();
        for (std::size_t i = 0; i < 2; ++i) RC_ASSERT(one.total(i) == many.total(i));
        RC_ASSERT(one.dram()->total() == many.dram()->total());
    });
    ASSERT_TRUE(holds);
}

}  // namespace
}  // namespace regather::cachesim
