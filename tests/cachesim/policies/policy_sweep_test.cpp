#include "cachesim/policies/policy_sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <rapidcheck.h>
#include <tbb/global_control.h>

#include "cachesim/cache.h"
#include "tests/cachesim/brute_force.h"
#include "trace/error.h"

namespace regather::cachesim {
namespace {

const auto unheard = [](std::uint64_t, std::uint64_t) {};

std::vector<PolicyRow> rows_of(std::span<const PolicyConfig> configs, std::span<const ByteAccess> accesses,
                               const PolicySweepOptions& options = {}) {
    PolicySweep sweep(configs, options);
    // In uneven batches: what a batch is must not matter.
    for (std::size_t begin = 0, size = 1; begin < accesses.size(); begin += size, size = size * 3 + 1)
        sweep.access(accesses.subspan(begin, std::min(size, accesses.size() - begin)));
    return sweep.finish(unheard);
}

std::vector<ByteAccess> bytes_of(const std::vector<std::uint64_t>& lines) {
    std::vector<ByteAccess> accesses;
    for (const std::uint64_t line : lines) accesses.push_back({line * 64, 4, Access::read});
    return accesses;
}

std::vector<ByteAccess> scattered_accesses(std::uint64_t seed, std::size_t count) {
    Scatter scatter(seed);
    std::vector<ByteAccess> accesses(count);
    for (ByteAccess& access : accesses)
        access = {scatter.below(1 + scatter.below(1 << 14)), 1 + scatter.below(150),
                  scatter.below(4) == 0 ? Access::write : Access::read};
    return accesses;
}

std::vector<PolicyConfig> every_policy(const std::vector<CacheConfig>& geometries) {
    std::vector<PolicyConfig> configs;
    for (const CacheConfig& geometry : geometries)
        for (std::size_t policy = 0; policy < policy_names.size(); ++policy)
            configs.push_back({geometry, static_cast<Policy>(policy), {}, {}, {}, 3});
    return configs;
}

/// By definition, at 64 bytes a line, with the class of each miss.
PolicyRow row_by_definition(const PolicyConfig& config, std::span<const Touch> touches) {
    PolicyRow row{config, {}, MissClasses{}};
    BruteForcePolicy cache(config);
    PolicyConfig full_lru{{config.geometry.size_bytes, config.geometry.line_bytes, fully_associative}};
    BruteForcePolicy full(full_lru);
    std::set<std::uint64_t> seen;
    for (std::size_t i = 0; i < touches.size(); ++i) {
        const bool hit = cache.access(touches[i], touches.subspan(i + 1)), full_hit = full.access(touches[i]);
        const bool first = seen.insert(touches[i].line).second;
        if (!hit)
            ++(first ? row.classes->compulsory : full_hit ? row.classes->conflict : row.classes->capacity);
    }
    cache.flush();
    row.stats = cache.total();
    return row;
}

TEST(MissClasses, TwoLinesOfOneSetConflict) {
    // 4 sets of 1 way, lines 0 and 4 in set 0:   0 compulsory, 4 compulsory, 0 conflict, 4 conflict
    const PolicyConfig configs[] = {{{256, 64, 1}}};
    EXPECT_EQ(rows_of(configs, bytes_of({0, 4, 0, 4}))[0].classes, (MissClasses{2, 0, 2}));
}

TEST(MissClasses, ACycleTooLongIsACapacityMatter) {
    // 4 ways, 5 lines, three times.
    const PolicyConfig configs[] = {{{256, 64, fully_associative}},
                                    {{256, 64, fully_associative}, Policy::opt}};
    const auto rows = rows_of(configs, bytes_of({0, 1, 2, 3, 4, 0, 1, 2, 3, 4, 0, 1, 2, 3, 4}));
    EXPECT_EQ(rows[0].classes, (MissClasses{5, 10, 0}));
    // opt: 0123 m, 4 m (3 goes), 012 h, 3 m (2 goes), 401 h, 2 m (1 goes), 340 h -- and 1 2 3 4 once more:
    // 1 m, 2 h, 3 h, 4 h: 4 first fetches, then one miss in 4 accesses.
    EXPECT_EQ(rows[1].classes, (MissClasses{5, 2, 0}));
}

TEST(MissClasses, WhatAFullLruCacheWouldHitIsConflict) {
    // 2 sets of 1 way:       0 m   1 m   2 m (0 goes)   1 h   0 m (2 goes)
    // full LRU of 2 lines:   0     1 0   2 1            1 2   0 1: misses too, so capacity
    const PolicyConfig configs[] = {{{128, 64, 1}}};
    EXPECT_EQ(rows_of(configs, bytes_of({0, 1, 2, 1, 0}))[0].classes, (MissClasses{3, 1, 0}));
    // 0 m   2 m (0 goes)   0 m (2 goes), but full LRU holds 2 0: conflict
    EXPECT_EQ(rows_of(configs, bytes_of({0, 2, 0}))[0].classes, (MissClasses{2, 0, 1}));
}

TEST(FullLru, TellsTheNumberOfCachesThatMiss) {
    const std::uint64_t capacities[] = {1, 2, 4};
    FullLru full(capacities);  // used last ... longest ago, a bar at the end of each cache
    EXPECT_EQ(full.access(0), FullLru::first_touch);  // 0|
    EXPECT_EQ(full.access(1), FullLru::first_touch);  // 1|0|
    EXPECT_EQ(full.access(1), 0u);                    // 1|0|
    EXPECT_EQ(full.access(0), 1u);                    // 0|1|
    EXPECT_EQ(full.access(2), FullLru::first_touch);  // 2|0|1
    EXPECT_EQ(full.access(1), 2u);                    // 1|2|0
    EXPECT_EQ(full.access(3), FullLru::first_touch);  // 3|1|2 0|
    EXPECT_EQ(full.access(4), FullLru::first_touch);  // 4|3|1 2|0
    EXPECT_EQ(full.access(0), 3u);                    // 0|4|3 1|2
    EXPECT_EQ(full.access(1), 2u);                    // 1|0|4 3|2
    EXPECT_EQ(full.access(2), 3u);                    // 2|1|0 4|3
}

TEST(FullLru, EqualsAListForEachCapacity) {
    ASSERT_TRUE(rc::check([] {
        auto capacities =
            *rc::gen::unique<std::vector<std::uint64_t>>(rc::gen::inRange<std::uint64_t>(1, 40));
        std::sort(capacities.begin(), capacities.end());
        const auto lines = *rc::gen::scale(
            5.0, rc::gen::container<std::vector<std::uint64_t>>(rc::gen::inRange<std::uint64_t>(0, 50)));
        std::vector<BruteForcePolicy> lists;
        for (const std::uint64_t capacity : capacities)
            lists.emplace_back(PolicyConfig{{capacity * 64, 64, fully_associative}});
        FullLru full(capacities);
        std::map<std::uint64_t, std::uint32_t> ids;
        for (const std::uint64_t line : lines) {
            const auto [id, first] = ids.emplace(line, ids.size());
            std::uint32_t missing = 0;
            for (BruteForcePolicy& list : lists) missing += !list.access({line});
            RC_ASSERT(full.access(id->second) == (first ? FullLru::first_touch : missing));
        }
    }));
}

TEST(PolicySweep, EqualsTheDefinitionOfEveryPolicyAndClass) {
    ASSERT_TRUE(rc::check([] {
        const std::vector<PolicyConfig> configs = every_policy(
            {{256, 64, 1}, {256, 64, fully_associative}, {1024, 64, 4}, {1024, 64, 1}, {768, 64, 4}});
        const auto lines = *rc::gen::scale(
            3.0, rc::gen::container<std::vector<std::uint64_t>>(rc::gen::inRange<std::uint64_t>(0, 40)));
        std::vector<ByteAccess> accesses;
        std::vector<Touch> touches;
        for (const std::uint64_t line : lines) {
            touches.push_back({line, line % 3 == 0, 4, trace::Region::other});
            accesses.push_back({line * 64, 4, line % 3 == 0 ? Access::write : Access::read});
        }
        const std::vector<PolicyRow> rows = rows_of(configs, accesses);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            RC_ASSERT(rows[i].config.policy == configs[i].policy);
            if (configs[i].policy == Policy::random) continue;
            const PolicyRow expected = row_by_definition(configs[i], touches);
            RC_ASSERT(rows[i].stats == expected.stats);
            RC_ASSERT(rows[i].classes == expected.classes);
        }
    }));
}

TEST(PolicySweep, SumsHoldForEveryCache) {
    std::vector<PolicyConfig> configs = every_policy(
        {{4096, 64, 4}, {4096, 64, 1}, {4096, 64, fully_associative}, {2048, 32, 8}, {1024, 128, 2}});
    for (PolicyConfig config : every_policy({{4096, 64, 4}})) {
        config.write = WritePolicy::through;
        configs.push_back(config);
        if (config.policy == Policy::opt) continue;
        config.write_miss = WriteMiss::no_allocate;
        config.index = SetIndex::hashed;
        configs.push_back(config);
    }
    const auto rows = rows_of(configs, scattered_accesses(1, 30'000));
    std::map<std::uint64_t, std::uint64_t> fewest;  // misses of opt, by geometry
    const auto key = [](const CacheConfig& g) { return g.size_bytes << 32 | g.line_bytes << 16 | g.ways; };
    for (const auto& [config, stats, classes] : rows)
        if (config.policy == Policy::opt) fewest[key(config.geometry)] = stats.misses;
    for (const auto& [config, stats, classes] : rows) {
        ASSERT_TRUE(classes);
        EXPECT_EQ(classes->compulsory + classes->capacity + classes->conflict, stats.misses);
        EXPECT_EQ(stats.hits() + stats.misses, stats.accesses);
        EXPECT_GT(classes->capacity, 0u);
        const bool allocates = config.write_miss == WriteMiss::allocate;
        if (allocates) {
            EXPECT_EQ(stats.fetches, stats.misses);
            EXPECT_LE(fewest.at(key(config.geometry)), stats.misses) << name_of(config.policy);
        }
        if (config.policy == Policy::lru && config.geometry.ways == fully_associative) {
            EXPECT_EQ(classes->conflict, 0u);
        }
    }
}

/// The bytes of a write that straddles lines are told apart: 3 on line 0, 64 on line 1 and 2 on line 2.
TEST(PolicySweep, PassesTheBytesWrittenOnEachLine) {
    PolicyConfig through{{1024, 64, 2}}, around{{1024, 64, 2}};
    through.write = WritePolicy::through;
    around.write_miss = WriteMiss::no_allocate;
    const PolicyConfig configs[] = {through, around};
    const ByteAccess accesses[] = {{64, 1, Access::read}, {61, 69, Access::write}};
    const auto rows = rows_of(configs, accesses);
    EXPECT_EQ(rows[0].stats, (PolicyStats{4, 3, 3, 0, 3, 69}));
    EXPECT_EQ(rows[0].stats.traffic_bytes(64), 3u * 64u + 69u);
    EXPECT_EQ(rows[1].stats, (PolicyStats{4, 3, 1, 1, 2, 3 + 2}));  // line 1 is held
}

/// One access at a time for the classes, batch by batch without them, and each LruCache by itself.
TEST(PolicySweep, LruCountsAreThoseOfEachLruCacheByItself) {
    const std::vector<CacheConfig> geometries{
        {4096, 64, 4}, {16384, 64, 8}, {4096, 64, fully_associative}, {2048, 32, 1}, {6144, 32, 3}};
    std::vector<PolicyConfig> configs;
    for (const CacheConfig& geometry : geometries) configs.push_back({geometry});
    const std::vector<ByteAccess> accesses = scattered_accesses(2, 60'000);
    std::vector<CacheStats> alone;
    for (const CacheConfig& geometry : geometries) {
        LruCache cache(geometry);
        for (const ByteAccess& access : accesses) {
            std::vector<Line> lines;
            append_lines(lines, access.address, access.bytes, geometry.line_bytes);
            cache.access(lines, trace::Region::other, access.kind);
        }
        cache.flush();
        alone.push_back(cache.total());
    }
    for (const bool classes : {true, false}) {
        const auto rows = rows_of(configs, accesses, {classes, 0});
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const CacheStats& expected = alone[i];
            EXPECT_EQ(rows[i].stats, (PolicyStats{expected.accesses, expected.misses, expected.misses,
                                                  expected.writebacks, 0, 0}));
            EXPECT_EQ(rows[i].classes.has_value(), classes);
        }
    }
}

TEST(PolicySweep, LruCountsAreThoseOfListsByteByByte) {
    const CacheConfig geometries[] = {
        {16 * 1024, 64, 8}, {4 * 1024, 32, 1},  {16 * 1024, 64, fully_associative},
        {1024, 1, 4},       {12 * 1024, 64, 3}, {16 * 1024, 64, 8}};
    std::vector<PolicyConfig> configs;
    for (const CacheConfig& geometry : geometries) configs.push_back({geometry});
    for (const bool write_some : {false, true}) {
        Scatter scatter(3);
        std::vector<ByteAccess> accesses(50'000);
        for (ByteAccess& access : accesses)
            access = {scatter.below(1 + scatter.below(1 << 16)), 1 + scatter.below(100),
                      write_some && scatter.below(4) == 0 ? Access::write : Access::read};
        const auto rows = rows_of(configs, accesses, {false, 0});
        ASSERT_EQ(rows.size(), std::size(geometries));
        for (std::size_t i = 0; i < rows.size(); ++i) {
            BruteForceLru list(geometries[i]);
            for (const ByteAccess& access : accesses)
                for (std::uint64_t byte = access.address, line = ~std::uint64_t{0};
                     byte < access.address + access.bytes; ++byte)
                    if (byte / geometries[i].line_bytes != line) {
                        line = byte / geometries[i].line_bytes;
                        list.access(Line{line}, trace::Region::other, access.kind);
                    }
            list.flush();
            const CacheStats& expected = list.stats[static_cast<std::size_t>(trace::Region::other)];
            EXPECT_EQ(rows[i].stats.accesses, expected.accesses) << "cache " << i;
            EXPECT_EQ(rows[i].stats.misses, expected.misses) << "cache " << i;
            EXPECT_EQ(rows[i].stats.writebacks, expected.writebacks) << "cache " << i;
        }
    }
}

TEST(PolicySweep, ALongAccessTouchesEveryLine) {
    const PolicyConfig configs[] = {{{1024, 1, 1}}, {{1024, 128, 1}}};
    const auto rows = rows_of(configs, std::vector{ByteAccess{64, 1'000'000, Access::write}}, {false, 0});
    EXPECT_EQ(rows[0].stats, (PolicyStats{1'000'000, 1'000'000, 1'000'000, 1'000'000, 0, 0}));
    EXPECT_EQ(rows[1].stats,
              (PolicyStats{7813, 7813, 7813, 7813, 0, 0}));  // bytes 64 to 1,000,063: lines 0 to 7812
}

TEST(PolicySweep, AnImpossibleGeometryIsRefused) {
    const PolicyConfig configs[] = {{{1024, 64, 1}}, {{1000, 64, 1}}};
    EXPECT_THROW(PolicySweep sweep(configs), trace::UsageError);
}

TEST(PolicySweep, CountsDoNotDependOnThreadsOrOnTheOrderAskedFor) {
    std::vector<PolicyConfig> configs = every_policy({{4096, 64, 4}, {2048, 32, 2}, {8192, 64, 16}});
    const std::vector<ByteAccess> accesses = scattered_accesses(4, 20'000);
    const auto rows = rows_of(configs, accesses);
    std::reverse(configs.begin(), configs.end());
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const auto turned = rows_of(configs, accesses);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i].stats, turned[rows.size() - 1 - i].stats);
        EXPECT_EQ(rows[i].classes, turned[rows.size() - 1 - i].classes);
    }
}

TEST(PolicySweep, OptHasALimitAndTellsItsProgress) {
    const PolicyConfig configs[] = {{{1024, 64, 2}, Policy::opt}, {{1024, 32, 2}, Policy::opt}};
    const std::vector<ByteAccess> accesses(1000, ByteAccess{0, 64, Access::read});  // 1000 and 2000 lines
    EXPECT_THROW(rows_of(configs, accesses, {true, 1999}), trace::UsageError);
    PolicySweep sweep(configs, {true, 2000});
    sweep.access(accesses);
    std::pair<std::uint64_t, std::uint64_t> last;
    sweep.finish([&](std::uint64_t done, std::uint64_t total) { last = {done, total}; });
    EXPECT_EQ(last, std::pair(std::uint64_t{3000}, std::uint64_t{3000}));
}

}  // namespace
}  // namespace regather::cachesim
