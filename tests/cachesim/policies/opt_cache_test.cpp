#include "cachesim/policies/opt_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <rapidcheck.h>

#include <string>

#include "cachesim/line_ids.h"
#include "cachesim/policies/policy_cache.h"
#include "tests/cachesim/brute_force.h"
#include "trace/error.h"

namespace regather::cachesim {
namespace {

OptStream stream_of(std::span<const Touch> touches) {
    OptStream stream(touches.size());
    LineIds ids;
    for (const Touch& touch : touches)
        stream.append(Line{touch.line}, ids(Line{touch.line}), touch.write ? Access::write : Access::read,
                      touch.bytes);
    stream.finish();
    return stream;
}

/// A letter is a line; a small one writes.
std::vector<Touch> touches_of(const std::string& letters) {
    std::vector<Touch> touches;
    for (const char letter : letters)
        touches.push_back({static_cast<std::uint64_t>((letter | 0x20) - 'a'), letter >= 'a'});
    return touches;
}

std::vector<std::uint8_t> access_all(OptCache& cache, const OptStream& stream) {
    std::vector<std::uint8_t> missed(stream.size());
    cache.access(missed);
    return missed;
}

PolicyStats stats_of_opt(const PolicyConfig& config, std::span<const Touch> touches) {
    const OptStream stream = stream_of(touches);
    OptCache cache(config, stream);
    access_all(cache, stream);
    cache.flush();
    return cache.total();
}

PolicyConfig one_set(std::uint32_t ways) {
    return {{std::uint64_t{64} * ways, 64, ways}, Policy::opt};
}

std::string hits_and_misses(const PolicyConfig& config, const std::string& letters) {
    const std::vector<Touch> touches = touches_of(letters);
    const OptStream stream = stream_of(touches);
    OptCache cache(config, stream);
    std::string text;
    for (const std::uint8_t miss : access_all(cache, stream)) text += miss ? 'm' : 'h';
    return text;
}

TEST(OptCache, ReplacesTheLineWhoseNextUseIsFarthest) {
    // 3 ways:           A    AB   ABC  ABD  ABD  ABD  EBD  EBD  CBD  CBD
    //                   C is used after A and B: it goes for D. After the 6th, A is never used again.
    EXPECT_EQ(hits_and_misses(one_set(3), "ABCDABEBCD"), "mmmmhhmhmh");
    // 2 ways:           A    AB   AC   AC   DC   DC        B never again, then A never again
    EXPECT_EQ(hits_and_misses(one_set(2), "ABCADC"), "mmmhmh");
}

TEST(OptCache, FillsWithALineThatIsNeverUsedAgain) {
    // 1 way: without bypass the scan of B, C costs A its place.
    EXPECT_EQ(hits_and_misses(one_set(1), "ABAACA"), "mmmhmm");
}

/// Of dirty A and clean B, both never used again, A goes first: it is written back before the flush.
TEST(OptCache, AmongLinesNeverUsedAgainTheSmallestGoes) {
    const auto written_back = [](const std::string& letters) {
        const std::vector<Touch> touches = touches_of(letters);
        const OptStream stream = stream_of(touches);
        OptCache cache(one_set(2), stream);
        access_all(cache, stream);
        return cache.total().writebacks;
    };
    EXPECT_EQ(written_back("aBC"), 1u);
    EXPECT_EQ(written_back("BaC"), 1u);
    EXPECT_EQ(written_back("Abc"), 0u);
    EXPECT_EQ(written_back("bAC"), 0u);
}

/// Belady, Nelson, Shedler (1969): the string of the anomaly; and the string of Silberschatz, Galvin, Gagne.
TEST(OptCache, CountsTheTextbooksPageFaults) {
    const auto misses = [](std::uint32_t ways, const std::string& references) {
        std::vector<Touch> touches;
        for (const char reference : references) touches.push_back({static_cast<std::uint64_t>(reference)});
        return stats_of_opt(one_set(ways), touches).misses;
    };
    EXPECT_EQ(misses(3, "123412512345"), 7u);
    EXPECT_EQ(misses(4, "123412512345"), 6u);
    EXPECT_EQ(misses(3, "70120304230321201701"), 9u);
}

/// A cycle of n + 1 lines through n ways: all miss under LRU; here a miss is followed by n - 1 hits.
TEST(OptCache, ACycleOfOneLineMoreMissesOnceInWays) {
    constexpr std::uint64_t ways = 100, rounds = 50;
    std::vector<Touch> touches;
    for (std::uint64_t i = 0; i < rounds * (ways + 1); ++i) touches.push_back({i % (ways + 1)});
    const PolicyStats stats = stats_of_opt(one_set(ways), touches);
    const std::uint64_t after_the_first = touches.size() - ways;
    EXPECT_EQ(stats.misses, ways + (after_the_first + ways - 1) / ways);
}

TEST(OptCache, WritesBackOrThrough) {
    PolicyConfig config = one_set(2);
    const std::vector<Touch> touches = touches_of("aBCaC");  // B goes for C; a is dirty at the end
    EXPECT_EQ(stats_of_opt(config, touches), (PolicyStats{5, 3, 3, 1, 0, 0}));
    config.write = WritePolicy::through;
    EXPECT_EQ(stats_of_opt(config, touches), (PolicyStats{5, 3, 3, 0, 2, 8}));
}

TEST(OptCache, ALongerStreamThanTheLimitIsRefused) {
    OptStream stream(2);
    stream.append(Line{1}, 0, Access::read, 1);
    stream.append(Line{1}, 0, Access::read, 1);
    try {
        stream.append(Line{1}, 0, Access::read, 1);
        FAIL();
    } catch (const trace::UsageError& error) {
        EXPECT_THAT(error.what(),
                    testing::StartsWith("policy opt: found more than 2 line accesses, expected at most"));
    }
}

TEST(LineIds, NumberLinesInTheOrderOfTheirFirstTouch) {
    LineIds ids;
    std::map<std::uint64_t, std::uint32_t> expected;
    Scatter scatter(1);
    for (int i = 0; i < 100'000; ++i) {
        const std::uint64_t line = scatter.below(30'000) * 0xfedcba9876543211;
        const auto found = expected.emplace(line, expected.size()).first;
        ASSERT_EQ(ids(Line{line}), found->second);
    }
    EXPECT_EQ(ids.size(), expected.size());
    EXPECT_EQ(ids(Line{~std::uint64_t{0}}), expected.size());
}

std::vector<Touch> any_touches(std::uint64_t most_lines) {
    const std::uint64_t base = *rc::gen::element<std::uint64_t>(0, 0 - most_lines);
    const auto spread = *rc::gen::inRange<std::uint64_t>(1, most_lines);
    return *rc::gen::scale(3.0, rc::gen::container<std::vector<Touch>>(rc::gen::apply(
                                    [=](std::uint64_t line, bool write) {
                                        return Touch{base + line, write};
                                    },
                                    rc::gen::inRange<std::uint64_t>(0, spread), rc::gen::arbitrary<bool>())));
}

TEST(OptCache, EqualsASearchOfTheFutureAccessByAccess) {
    ASSERT_TRUE(rc::check([] {
        PolicyConfig config;
        config.policy = Policy::opt;
        config.write = *rc::gen::element(WritePolicy::back, WritePolicy::through);
        const std::uint32_t ways = *rc::gen::element(1u, 2u, 3u, 8u, 16u, 40u);
        const std::uint32_t sets = *rc::gen::element(1u, 2u, 3u, 4u);
        if (sets != 3) config.index = *rc::gen::element(SetIndex::modulo, SetIndex::hashed);
        config.geometry = {std::uint64_t{64} * sets * ways, 64, ways};
        const std::vector<Touch> touches = any_touches(200);
        const OptStream stream = stream_of(touches);
        OptCache cache(config, stream);
        BruteForcePolicy definition(config);
        std::array<std::uint8_t, 1> missed;
        for (std::size_t i = 0; i < touches.size(); ++i) {
            cache.access(missed);
            RC_ASSERT((missed[0] == 0) == definition.access(touches[i], std::span(touches).subspan(i + 1)));
        }
        cache.flush();
        definition.flush();
        RC_ASSERT(cache.total() == definition.total());
    }));
}

/// Long enough for what is over to be cleared away many times.
TEST(OptCache, EqualsASearchOfTheFutureOverManyAccesses) {
    Scatter scatter(6);
    std::vector<Touch> touches(6000);
    for (Touch& touch : touches) touch = {scatter.below(1 + scatter.below(300)), scatter.below(4) == 0};
    for (const std::uint32_t ways : {24u, 100u}) {
        BruteForcePolicy definition(one_set(ways));
        for (std::size_t i = 0; i < touches.size(); ++i)
            definition.access(touches[i], std::span(touches).subspan(i + 1));
        definition.flush();
        EXPECT_EQ(stats_of_opt(one_set(ways), touches), definition.total());
    }
}

TEST(OptCache, NoChoiceOfVictimsMissesLess) {
    ASSERT_TRUE(rc::check([] {
        std::vector<Touch> touches = any_touches(7);
        touches.resize(std::min<std::size_t>(touches.size(), 12));
        for (const std::uint32_t ways : {1u, 2u, 3u, 4u})
            RC_ASSERT(stats_of_opt(one_set(ways), touches).misses == fewest_misses(touches, ways));
    }));
}

TEST(OptCache, MissesNoMoreThanAnyPolicy) {
    ASSERT_TRUE(rc::check([] {
        const std::vector<Touch> touches = any_touches(100);
        PolicyConfig config;
        config.geometry = {std::uint64_t{64} * 4 * 8, 64, *rc::gen::element(1u, 4u, 8u, fully_associative)};
        config.policy = Policy::opt;
        const std::uint64_t fewest = stats_of_opt(config, touches).misses;
        for (const Policy policy : {Policy::lru, Policy::fifo, Policy::plru, Policy::srrip, Policy::random}) {
            config.policy = policy;
            PolicyCache cache(config);
            for (const Touch& touch : touches)
                cache.access(Line{touch.line}, Access::read, touch.region, touch.bytes);
            RC_ASSERT(fewest <= cache.total().misses);
        }
    }));
}

}  // namespace
}  // namespace regather::cachesim
