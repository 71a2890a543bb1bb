#include "cachesim/policies/policy_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <rapidcheck.h>

#include <string>

#include "tests/cachesim/brute_force.h"
#include "trace/error.h"

namespace regather::cachesim {
namespace {

using trace::Region;

/// One set, drawn after every access: the letters of the lines that its ways hold, way 0 first; * is dirty.
class DrawnSet {
public:
    DrawnSet(Policy policy, std::uint32_t ways, WritePolicy write = WritePolicy::back,
             WriteMiss write_miss = WriteMiss::allocate)
        : cache_({{ways * 64u, 64, ways}, policy, write, write_miss, SetIndex::modulo, 1}) {}

    /// A small letter writes. "h" or "m", and the set.
    std::string operator()(char letter) {
        const bool write = letter >= 'a';
        const Line line{static_cast<std::uint64_t>(write ? letter - 'a' : letter - 'A')};
        const auto [hit, evicted] =
            cache_.access(line, write ? Access::write : Access::read, Region::photons, 4);
        gone = evicted ? name(evicted->line) : '-';
        std::string text = hit ? "h " : "m ";
        for (std::size_t way = 0; way < cache_.config().ways(); ++way)
            if (const auto held = cache_.at(way)) {
                text += name(held->line);
                if (held->dirty) text += '*';
            }
        return text;
    }
    static char name(Line line) { return static_cast<char>('A' + static_cast<std::uint64_t>(line)); }

    PolicyCache& cache() { return cache_; }
    char gone = '-';

private:
    PolicyCache cache_;
};

std::uint64_t misses(Policy policy, std::uint32_t ways, const std::string& references) {
    DrawnSet set(policy, ways);
    for (const char reference : references) set(static_cast<char>('A' + (reference - '0')));
    return set.cache().total().misses;
}

TEST(PolicyCache, LruReplacesTheLineUsedLongestAgo) {
    DrawnSet set(Policy::lru, 3);  //           used last ... longest ago
    EXPECT_EQ(set('A'), "m A");    //           A
    EXPECT_EQ(set('B'), "m AB");   //           B A
    EXPECT_EQ(set('C'), "m ABC");  //           C B A
    EXPECT_EQ(set('A'), "h ABC");  //           A C B
    EXPECT_EQ(set('D'), "m ADC");  // B goes    D A C
    EXPECT_EQ(set('C'), "h ADC");  //           C D A
    EXPECT_EQ(set('B'), "m BDC");  // A goes    B C D
    EXPECT_EQ(set('A'), "m BAC");  // D goes    A B C
}

TEST(PolicyCache, FifoReplacesTheLineFetchedLongestAgo) {
    DrawnSet set(Policy::fifo, 3);  //           fetched last ... longest ago
    EXPECT_EQ(set('A'), "m A");     //           A
    EXPECT_EQ(set('B'), "m AB");    //           B A
    EXPECT_EQ(set('C'), "m ABC");   //           C B A
    EXPECT_EQ(set('A'), "h ABC");   //           C B A    a hit changes nothing
    EXPECT_EQ(set('D'), "m DBC");   // A goes    D C B
    EXPECT_EQ(set('B'), "h DBC");   //           D C B
    EXPECT_EQ(set('A'), "m DAC");   // B goes    A D C
    EXPECT_EQ(set('E'), "m DAE");   // C goes    E A D
}

TEST(PolicyCache, PlruFollowsTheBitsOfItsTree) {
    DrawnSet set(Policy::plru, 4);  //           root   ways 0|1   ways 2|3     where the bits point
    EXPECT_EQ(set('A'), "m A");     //           right  1          2
    EXPECT_EQ(set('B'), "m AB");    //           right  0          2
    EXPECT_EQ(set('C'), "m ABC");   //           left   0          3
    EXPECT_EQ(set('D'), "m ABCD");  //           left   0          2
    EXPECT_EQ(set('A'), "h ABCD");  //           right  1          2
    EXPECT_EQ(set('E'), "m ABED");  // C goes    left   1          3            lru would take B
    EXPECT_EQ(set('F'), "m AFED");  // B goes    right  0          3
    EXPECT_EQ(set('G'), "m AFEG");  // D goes    left   0          2
    EXPECT_EQ(set('F'), "h AFEG");  //           right  0          2
    EXPECT_EQ(set('C'), "m AFCG");  // E goes    left   0          3
}

/// The mixed access pattern that the paper explains srrip with: A is used again and survives a scan of B's.
TEST(PolicyCache, SrripKeepsReusedLinesThroughAScan) {
    DrawnSet set(Policy::srrip, 4);  //                                  predictions of ways 0 1 2 3
    EXPECT_EQ(set('A'), "m A");      //                                  2 3 3 3
    EXPECT_EQ(set('B'), "m AB");     //                                  2 2 3 3
    EXPECT_EQ(set('B'), "h AB");     //                                  2 0 3 3
    EXPECT_EQ(set('A'), "h AB");     //                                  0 0 3 3
    EXPECT_EQ(set('P'), "m ABP");    //                                  0 0 2 3
    EXPECT_EQ(set('Q'), "m ABPQ");   //                                  0 0 2 2
    EXPECT_EQ(set('R'), "m ABRQ");   // all count up to 1 1 3 3, P goes  1 1 2 3
    EXPECT_EQ(set('S'), "m ABRS");   // Q goes                           1 1 2 2
    EXPECT_EQ(set('A'), "h ABRS");   //                                  0 1 2 2
    EXPECT_EQ(set('B'), "h ABRS");   //                                  0 0 2 2
    EXPECT_EQ(misses(Policy::lru, 4, "01102345"), 6u);
    EXPECT_EQ(misses(Policy::lru, 4, "0110234501"), 8u);  // lru has lost both
}

TEST(PolicyCache, SrripWithoutADistantLineCountsUpUntilThereIsOne) {
    DrawnSet set(Policy::srrip, 2);
    set('A'), set('B'), set('A');  //                                 0 2
    EXPECT_EQ(set('B'), "h AB");   //                                 0 0
    EXPECT_EQ(set('C'), "m CB");   // three times up: 3 3, A goes     2 3
    EXPECT_EQ(set('D'), "m CD");   // B goes                          2 2
}

/// Belady, Nelson, Shedler (1969): a larger FIFO store may miss more.
TEST(PolicyCache, FifoShowsBeladysAnomaly) {
    const std::string references = "123412512345";
    EXPECT_EQ(misses(Policy::fifo, 3, references), 9u);
    EXPECT_EQ(misses(Policy::fifo, 4, references), 10u);
    EXPECT_EQ(misses(Policy::lru, 3, references), 10u);
    EXPECT_EQ(misses(Policy::lru, 4, references), 8u);
}

/// Silberschatz, Galvin, Gagne, "Operating System Concepts", the chapter on virtual memory.
TEST(PolicyCache, CountsTheTextbooksPageFaults) {
    const std::string references = "70120304230321201701";
    EXPECT_EQ(misses(Policy::fifo, 3, references), 15u);
    EXPECT_EQ(misses(Policy::lru, 3, references), 12u);
}

TEST(PolicyCache, RandomRepeatsWithItsSeedOnly) {
    const auto evicted = [](std::uint64_t seed) {
        PolicyCache cache({{8 * 64, 64, 8}, Policy::random, {}, {}, {}, seed});
        std::vector<std::uint64_t> lines;
        for (std::uint64_t line = 0; line < 1000; ++line)
            if (const auto victim = cache.place(Line{line}, false, Region::other).evicted)
                lines.push_back(static_cast<std::uint64_t>(victim->line));
        return lines;
    };
    EXPECT_EQ(evicted(7).size(), 992u);
    EXPECT_EQ(evicted(7), evicted(7));
    EXPECT_NE(evicted(7), evicted(8));
    EXPECT_NE(evicted(7), evicted(7 + (std::uint64_t{1} << 32)));
}

/// The age of a line at its eviction is geometric: 1/8 of the lines go at the next fetch.
TEST(PolicyCache, RandomTreatsAllWaysAlike) {
    PolicyCache cache({{8 * 64, 64, 8}, Policy::random});
    std::uint64_t at_once = 0;
    std::array<std::uint64_t, 8> by_way{};
    for (std::uint64_t line = 0; line < 80'008; ++line) {
        const auto [way, victim] = cache.place(Line{line}, false, Region::other);
        if (!victim) continue;
        at_once += victim->line == Line{line - 1};
        ++by_way[way];
    }
    // The standard deviation of each count is 94.
    EXPECT_NEAR(static_cast<double>(at_once), 10'000, 400);
    for (const std::uint64_t count : by_way) EXPECT_NEAR(static_cast<double>(count), 10'000, 400);
}

/// Of lines that are all alike, whatever is kept is as good: the hits are ways / lines.
TEST(PolicyCache, EveryPolicyHitsAlikeOnUniformAccesses) {
    for (const Policy policy : {Policy::lru, Policy::fifo, Policy::plru, Policy::srrip, Policy::random})
        for (const std::uint32_t ways : {16u, 64u}) {
            PolicyCache cache({{ways * 64, 64, ways}, policy});
            Scatter scatter(5);
            for (int i = 0; i < 100'000; ++i)
                cache.access(Line{scatter.below(4 * ways)}, Access::read, Region::other, 4);
            EXPECT_NEAR(static_cast<double>(cache.total().hits()), 25'000, 700) << name_of(policy);
        }
}

TEST(PolicyCache, WritesBackWhatWasWritten) {
    DrawnSet set(Policy::lru, 2);
    EXPECT_EQ(set('a'), "m A*");
    EXPECT_EQ(set('B'), "m A*B");
    EXPECT_EQ(set('A'), "h A*B");
    EXPECT_EQ(set('b'), "h A*B*");
    EXPECT_EQ(set('C'), "m CB*");  // A is written back
    set.cache().flush();           // B is
    EXPECT_EQ(set.cache().total(), (PolicyStats{5, 3, 3, 2, 0, 0}));
    EXPECT_EQ(set.cache().traffic_bytes(), (3u + 2u) * 64u);
}

TEST(PolicyCache, WriteThroughPassesEveryWriteAndKeepsLinesClean) {
    DrawnSet set(Policy::lru, 2, WritePolicy::through);
    EXPECT_EQ(set('a'), "m A");  // fetched, 4 bytes pass
    EXPECT_EQ(set('a'), "h A");  // 4 bytes pass
    EXPECT_EQ(set('B'), "m AB");
    EXPECT_EQ(set('C'), "m CB");
    set.cache().flush();
    EXPECT_EQ(set.cache().total(), (PolicyStats{4, 3, 3, 0, 2, 8}));
    EXPECT_EQ(set.cache().traffic_bytes(), 3u * 64u + 8u);
}

TEST(PolicyCache, NoAllocatePassesWritesThatMiss) {
    DrawnSet back(Policy::lru, 2, WritePolicy::back, WriteMiss::no_allocate);
    EXPECT_EQ(back('a'), "m ");  // 4 bytes pass
    EXPECT_EQ(back('A'), "m A");
    EXPECT_EQ(back('a'), "h A*");
    EXPECT_EQ(back('b'), "m A*");  // 4 bytes pass
    back.cache().flush();          // A is written back
    EXPECT_EQ(back.cache().total(), (PolicyStats{4, 3, 1, 1, 2, 8}));

    DrawnSet through(Policy::lru, 2, WritePolicy::through, WriteMiss::no_allocate);
    EXPECT_EQ(through('a'), "m ");
    EXPECT_EQ(through('A'), "m A");
    EXPECT_EQ(through('a'), "h A");
    through.cache().flush();
    EXPECT_EQ(through.cache().total(), (PolicyStats{3, 2, 1, 0, 2, 8}));
}

TEST(PolicyCache, CountsAreKeptByRegion) {
    PolicyCache cache(PolicyConfig{{64, 64, 1}});
    cache.access(Line{0}, Access::write, Region::photons, 4);
    cache.access(Line{0}, Access::write, Region::reorder_buffer, 4);
    EXPECT_EQ(cache.access(Line{1}, Access::read, Region::other, 4).evicted,
              (Resident{Line{0}, true, Region::reorder_buffer}));
    EXPECT_EQ(cache.stats(Region::photons), (PolicyStats{1, 1, 1, 0, 0, 0}));
    EXPECT_EQ(cache.stats(Region::reorder_buffer), (PolicyStats{1, 0, 0, 1, 0, 0}));
    EXPECT_EQ(cache.stats(Region::other), (PolicyStats{1, 1, 1, 0, 0, 0}));
}

// ---- the steps ----

class Steps : public testing::TestWithParam<Policy> {};
INSTANTIATE_TEST_SUITE_P(Policies, Steps,
                         testing::Values(Policy::lru, Policy::fifo, Policy::plru, Policy::srrip,
                                         Policy::random),
                         [](const auto& policy) { return std::string(name_of(policy.param)); });

TEST_P(Steps, CountNothing) {
    PolicyCache cache({{2 * 64, 64, 2}, GetParam()});
    EXPECT_EQ(cache.slot(Line{5}), PolicyCache::nowhere);
    const auto [slot, evicted] = cache.place(Line{5}, true, Region::photons);
    EXPECT_EQ(evicted, std::nullopt);
    EXPECT_EQ(cache.slot(Line{5}), slot);
    cache.use_at(slot);
    EXPECT_EQ(cache.at(slot), (Resident{Line{5}, true, Region::photons}));
    cache.remove_at(slot);
    EXPECT_EQ(cache.slot(Line{5}), PolicyCache::nowhere);
    EXPECT_EQ(cache.at(slot), std::nullopt);
    EXPECT_EQ(cache.total(), PolicyStats{});
}

/// In sets that are searched and in sets that are hashed.
TEST_P(Steps, WhatIsRemovedLeavesRoom) {
    for (const std::uint32_t ways : {4u, 64u}) {
        PolicyCache cache({{std::uint64_t{2} * ways * 64, 64, ways}, GetParam()});
        const auto holds = [&](std::uint64_t line) { return cache.slot(Line{line}) != PolicyCache::nowhere; };
        for (std::uint64_t line = 0; line < 2 * ways; ++line)
            EXPECT_EQ(cache.place(Line{line}, line % 4 == 0, Region::other).evicted, std::nullopt);
        const std::size_t third = cache.slot(Line{4});
        EXPECT_EQ(third, 2u);
        cache.remove_at(third);
        EXPECT_FALSE(holds(4));
        EXPECT_EQ(cache.place(Line{1000}, false, Region::other).slot, third);  // into the same way
        const auto [slot, evicted] = cache.place(Line{1002}, true, Region::photons);
        ASSERT_TRUE(evicted);
        EXPECT_FALSE(holds(static_cast<std::uint64_t>(evicted->line)));
        EXPECT_EQ(evicted->dirty, static_cast<std::uint64_t>(evicted->line) % 4 == 0 &&
                                      static_cast<std::uint64_t>(evicted->line) < 2 * ways);
        EXPECT_EQ(cache.at(slot), (Resident{Line{1002}, true, Region::photons}));
        for (std::uint64_t line = 0; line < 2 * ways; ++line)
            EXPECT_EQ(holds(line), line != 4 && Line{line} != evicted->line) << line;
        cache.clear();
        for (std::size_t any = 0; any < 2 * ways; ++any) EXPECT_EQ(cache.at(any), std::nullopt);
        EXPECT_FALSE(holds(1002));
        EXPECT_EQ(cache.place(Line{1002}, false, Region::other).slot, 0u);
    }
}

TEST(PolicyCache, OptIsRefused) {
    EXPECT_THROW(PolicyCache(PolicyConfig{{1024, 64, 2}, Policy::opt}), trace::UsageError);
    EXPECT_THROW(PolicyCache(PolicyConfig{{1024, 64, 3}}), trace::UsageError);
}

// ---- against the definition ----

/// Lines around any of several places of the address space, most of them few.
std::vector<Touch> any_touches() {
    const std::uint64_t base =
        *rc::gen::element<std::uint64_t>(0, 1000, std::uint64_t{1} << 33, 0 - std::uint64_t{400});
    const auto spread = *rc::gen::inRange<std::uint64_t>(1, 300);
    const auto touch = rc::gen::apply(
        [=](std::uint64_t line, bool write, std::uint32_t bytes, std::uint8_t region) {
            return Touch{base + line, write, bytes, static_cast<Region>(region)};
        },
        rc::gen::inRange<std::uint64_t>(0, spread), rc::gen::arbitrary<bool>(),
        rc::gen::inRange<std::uint32_t>(1, 65), rc::gen::inRange<std::uint8_t>(0, trace::region_count));
    return *rc::gen::scale(4.0, rc::gen::container<std::vector<Touch>>(touch));
}

TEST(PolicyCache, EqualsItsDefinitionAccessByAccess) {
    ASSERT_TRUE(rc::check([] {
        PolicyConfig config;
        config.policy = *rc::gen::element(Policy::lru, Policy::fifo, Policy::plru, Policy::srrip);
        config.write = *rc::gen::element(WritePolicy::back, WritePolicy::through);
        config.write_miss = *rc::gen::element(WriteMiss::allocate, WriteMiss::no_allocate);
        const bool powers = config.policy == Policy::plru;
        const std::uint32_t ways = powers ? *rc::gen::element(1u, 2u, 4u, 8u, 32u, 64u)
                                          : *rc::gen::element(1u, 2u, 3u, 5u, 8u, 32u, 33u, 50u);
        const std::uint32_t sets = *rc::gen::element(1u, 2u, 3u, 7u, 8u, 12u);
        config.index = (sets & (sets - 1)) == 0 ? *rc::gen::element(SetIndex::modulo, SetIndex::hashed)
                                                : SetIndex::modulo;
        config.geometry = {std::uint64_t{64} * sets * ways, 64, sets == 1 ? fully_associative : ways};
        PolicyCache cache(config);
        BruteForcePolicy definition(config);
        for (const Touch& touch : any_touches()) {
            const Access kind = touch.write ? Access::write : Access::read;
            RC_ASSERT(cache.access(Line{touch.line}, kind, touch.region, touch.bytes).hit ==
                      definition.access(touch));
        }
        cache.flush();
        definition.flush();
        for (std::size_t region = 0; region < trace::region_count; ++region)
            RC_ASSERT(cache.stats(static_cast<Region>(region)) == definition.stats[region]);
    }));
}

TEST(PolicyCache, LruEqualsTheFastLruCache) {
    for (const CacheConfig& geometry :
         {CacheConfig{64 * 64, 64, 4}, CacheConfig{256 * 64, 64, 8}, CacheConfig{1024, 64, 1},
          CacheConfig{128 * 64, 64, fully_associative}, CacheConfig{4 * 48 * 64, 64, 48}}) {
        PolicyCache cache(PolicyConfig{geometry});
        LruCache fast(geometry);
        Scatter scatter(9);
        for (int i = 0; i < 50'000; ++i) {
            const Line line{(std::uint64_t{1} << 60) + scatter.below(1 + scatter.below(1000))};
            const Access kind = scatter.below(3) == 0 ? Access::write : Access::read;
            cache.access(line, kind, Region::photons, 4);
            fast.access({&line, 1}, Region::photons, kind);
        }
        cache.flush();
        fast.flush();
        EXPECT_EQ(cache.total().misses, fast.total().misses);
        EXPECT_EQ(cache.total().writebacks, fast.total().writebacks);
        EXPECT_EQ(cache.traffic_bytes(), fast.traffic_bytes());
    }
}

TEST(PolicyCache, MoreWaysAtEqualSetsNeverMissMoreUnderLru) {
    ASSERT_TRUE(rc::check([] {
        const std::uint32_t sets = *rc::gen::element(1u, 3u, 4u);
        const std::vector<Touch> touches = any_touches();
        std::uint64_t before = ~std::uint64_t{0};
        for (std::uint32_t ways = 1; ways <= 40; ways += ways < 8 ? 1 : 8) {
            PolicyCache cache(PolicyConfig{{std::uint64_t{64} * sets * ways, 64, ways}});
            for (const Touch& touch : touches)
                cache.access(Line{touch.line}, Access::read, touch.region, touch.bytes);
            RC_ASSERT(cache.total().misses <= before);
            before = cache.total().misses;
        }
    }));
}

}  // namespace
}  // namespace regather::cachesim
