#include "cachesim/cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "trace/error.h"

namespace regather::cachesim {
namespace {

using trace::Region;

/// One set of few ways, kept in lists; and set 0 of 16 sets, kept in rows of tags. A line's number is that of
/// its letter times the sets, so that all fall into the set that is drawn.
class DrawnSet : public testing::TestWithParam<std::uint32_t> {
protected:
    LruCache cache(std::uint32_t ways) const {
        return LruCache({std::uint64_t{GetParam()} * ways * 32, 32, ways});
    }
    Line line(char letter) const { return Line{static_cast<std::uint64_t>(letter - 'A') * GetParam()}; }

    /// m or h for each letter; lower case writes.
    std::string access(LruCache& cache, const std::string& letters, Region region = Region::other) const {
        std::string outcomes;
        for (const char letter : letters) {
            const std::uint64_t before = cache.total().misses;
            const bool write = letter >= 'a';
            cache.access(std::vector{line(write ? static_cast<char>(letter - 'a' + 'A') : letter)}, region,
                         write ? Access::write : Access::read);
            outcomes += cache.total().misses == before ? 'h' : 'm';
        }
        return outcomes;
    }
};
INSTANTIATE_TEST_SUITE_P(Sets, DrawnSet, testing::Values(1, 2, 16, 64));

TEST_P(DrawnSet, TwoWaysKeepTheTwoLinesUsedLast) {
    LruCache two = cache(2);
    EXPECT_EQ(access(two, "A"), "m");  // A -
    EXPECT_EQ(access(two, "B"), "m");  // B A
    EXPECT_EQ(access(two, "A"), "h");  // A B
    EXPECT_EQ(access(two, "C"), "m");  // C A   without B
    EXPECT_EQ(access(two, "A"), "h");  // A C
    EXPECT_EQ(access(two, "B"), "m");  // B A   without C
    EXPECT_EQ(access(two, "B"), "h");  // B A
    EXPECT_EQ(access(two, "C"), "m");  // C B   without A
}

TEST_P(DrawnSet, ThreeWaysHitInTheMiddleAndAtTheEnd) {
    LruCache three = cache(3);
    EXPECT_EQ(access(three, "ABC"), "mmm");  // C B A
    EXPECT_EQ(access(three, "B"), "h");      // B C A
    EXPECT_EQ(access(three, "A"), "h");      // A B C
    EXPECT_EQ(access(three, "D"), "m");      // D A B   without C
    EXPECT_EQ(access(three, "B"), "h");      // B D A
    EXPECT_EQ(access(three, "C"), "m");      // C B D   without A
    EXPECT_EQ(access(three, "DB"), "hh");    // B D C
    EXPECT_EQ(access(three, "A"), "m");      // A B D
}

TEST_P(DrawnSet, OneWayHoldsTheLastLineOnly) {
    LruCache direct_mapped = cache(1);
    EXPECT_EQ(access(direct_mapped, "AABBA"), "mhmhm");
}

TEST_P(DrawnSet, AnEvictedDirtyLineIsWrittenBackOnce) {
    LruCache two = cache(2);
    access(two, "aB");  // B a    small: dirty
    EXPECT_EQ(two.total().writebacks, 0u);
    access(two, "C");  // C B    a is written back
    EXPECT_EQ(two.total().writebacks, 1u);
    access(two, "AB");  // B A    both clean
    access(two, "CD");  // D C
    EXPECT_EQ(two.total().writebacks, 1u);
    EXPECT_EQ(two.total().misses, 7u);
    EXPECT_EQ(two.traffic_bytes(), (7u + 1u) * 32u);
}

TEST_P(DrawnSet, ReadingADirtyLineLeavesItDirty) {
    LruCache two = cache(2);
    access(two, "aBA");  // a B
    access(two, "CD");   // D C
    EXPECT_EQ(two.total().writebacks, 1u);
}

TEST_P(DrawnSet, AWritebackIsChargedToTheRegionThatWroteLast) {
    LruCache two = cache(2);
    access(two, "a", Region::photons);         // a -    dirty by photons
    access(two, "a", Region::reorder_buffer);  // a -    dirty by reorder_buffer
    access(two, "bC", Region::other);          // C b    a is evicted by a read of other
    EXPECT_EQ(two.stats(Region::photons), (CacheStats{1, 1, 0}));
    EXPECT_EQ(two.stats(Region::reorder_buffer), (CacheStats{1, 0, 1}));
    EXPECT_EQ(two.stats(Region::other), (CacheStats{2, 2, 0}));
    two.flush();  // - -    b is evicted
    EXPECT_EQ(two.stats(Region::other), (CacheStats{2, 2, 1}));
    EXPECT_EQ(two.total(), (CacheStats{4, 3, 2}));
}

TEST_P(DrawnSet, NothingIsHeldAfterAFlush) {
    LruCache two = cache(2);
    access(two, "Ab");
    two.flush();
    EXPECT_EQ(access(two, "BA"), "mm");
    two.flush();
    EXPECT_EQ(two.total().writebacks, 1u);  // b, at the first flush
}

TEST(LruCache, LinesFallIntoSetsByTheirLowBits) {
    LruCache cache({16 * 64, 64, 1});
    const auto misses = [&](std::vector<Line> lines) {
        const std::uint64_t before = cache.total().misses;
        cache.access(lines, Region::photons);
        return cache.total().misses - before;
    };
    EXPECT_EQ(misses({Line{0}, Line{15}, Line{0}, Line{15}}), 2u);  // sets 0 and 15
    EXPECT_EQ(misses({Line{16}, Line{0}, Line{16}, Line{0}}), 4u);  // both in set 0
    EXPECT_EQ(misses({Line{31}, Line{15}}), 2u);                    // both in set 15
    EXPECT_EQ(misses({Line{1}, Line{2}, Line{4}, Line{8}}), 4u);
    EXPECT_EQ(misses({Line{1}, Line{2}, Line{4}, Line{8}}), 0u);
}

TEST(LruCache, AFullCacheMissesEveryTimeOnACycleOfOneLineMore) {
    constexpr std::uint64_t held = 1000;  // full associativity takes any number of lines
    for (const std::uint64_t cycle : {held, held + 1}) {
        LruCache cache({held * 128, 128, fully_associative});
        for (int round = 0; round < 5; ++round)
            for (std::uint64_t line = 0; line < cycle; ++line)
                cache.access(std::vector{Line{line}}, Region::photons);
        EXPECT_EQ(cache.total().misses, cycle == held ? held : 5 * cycle);
    }
}

/// The value that marks an empty way must not pass for a line.
TEST(LruCache, NoLineHitsInAnEmptyCache) {
    for (const std::uint32_t ways : {1u, 3u, 8u, 16u, 32u, fully_associative})
        for (int shift = 0; shift < 64; ++shift)
            for (const std::uint64_t below : {0, 1, 2}) {
                const std::uint64_t sets = 32, line = (~std::uint64_t{0} >> shift) - below;
                LruCache cache({sets * (ways == fully_associative ? 1 : ways), 1, ways});
                cache.access(std::vector{Line{line}, Line{line}}, Region::photons);
                ASSERT_EQ(cache.total(), (CacheStats{2, 1, 0})) << line << ' ' << ways;
            }
}

TEST(LruCache, LinesThatDifferInHighBitsOnlyAreDifferent) {
    LruCache cache({32 * 8, 1, 8});
    for (int bit = 63; bit > 56; --bit)
        cache.access(std::vector{Line{std::uint64_t{1} << bit}}, Region::photons);
    EXPECT_EQ(cache.total().misses, 7u);
    for (int bit = 63; bit > 56; --bit)
        cache.access(std::vector{Line{std::uint64_t{1} << bit}}, Region::photons);
    EXPECT_EQ(cache.total().misses, 7u);
}

/// A line of a high number makes the cache keep wider tags: what was held, its order and who wrote it stay.
TEST(LruCache, ALargeLineNumberChangesNothingForTheLinesHeld) {
    LruCache cache({32 * 4, 1, 4});
    const auto hits = [&](std::uint64_t line) {
        const std::uint64_t before = cache.total().misses;
        cache.access(std::vector{Line{32 * line}}, Region::photons);
        return cache.total().misses == before;
    };
    cache.access(std::vector{Line{32}}, Region::reorder_buffer, Access::write);
    for (const std::uint64_t line : {2, 3}) hits(line);  // 3 2 1*  -
    EXPECT_FALSE(hits(std::uint64_t{1} << 58));          // h 3 2 1*
    EXPECT_TRUE(hits(2));                                // 2 h 3 1*
    EXPECT_FALSE(hits(4));                               // 4 2 h 3
    EXPECT_EQ(cache.stats(Region::reorder_buffer).writebacks, 1u);
    EXPECT_TRUE(hits(3));                       // 3 4 2 h
    EXPECT_TRUE(hits(std::uint64_t{1} << 58));  // h 3 4 2
    EXPECT_FALSE(hits(0));                      // 0 h 3 4
    EXPECT_FALSE(hits(2));                      // 2 0 h 3
}

TEST(LruCache, AMovedCacheGoesOn) {
    LruCache first({1024, 64, 2});
    first.access(std::vector{Line{7}}, Region::photons);
    LruCache second = std::move(first);
    second.access(std::vector{Line{7}}, Region::photons);
    EXPECT_EQ(second.total(), (CacheStats{2, 1, 0}));
}

std::string refusal(const CacheConfig& config) {
    try {
        LruCache cache(config);
    } catch (const trace::UsageError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Check, ImpossibleGeometriesAreRefusedByField) {
    using testing::StartsWith;
    EXPECT_THAT(refusal({1024, 0, 1}), StartsWith("line_bytes: found 0, expected a power of two"));
    EXPECT_THAT(refusal({96 * 4, 96, 1}), StartsWith("line_bytes: found 96, expected a power of two"));
    EXPECT_THAT(refusal({0, 64, 1}), StartsWith("size_bytes: found 0, expected a multiple of"));
    EXPECT_THAT(refusal({1000, 64, fully_associative}),
                StartsWith("size_bytes: found 1000, expected a multiple of"));
    EXPECT_THAT(refusal({32, 64, 1}), StartsWith("size_bytes: found 32, expected a multiple of"));
    EXPECT_THAT(refusal({1024, 64, 3}), StartsWith("ways: found 3 ways of 16 lines"));
    EXPECT_THAT(refusal({1024, 64, 32}), StartsWith("ways: found 32 ways of 16 lines"));
    EXPECT_THAT(refusal({3 * 1024, 64, 8}), testing::HasSubstr("which is 6 sets, expected a power of two"));
    EXPECT_THAT(refusal({std::uint64_t{1} << 40, 64, 8}),
                StartsWith("size_bytes: found 1099511627776, which is"));
}

TEST(Check, AnyWaysAreAcceptedOverAPowerOfTwoOfSets) {
    EXPECT_EQ(refusal({3 * 1024, 64, 3}), "accepted");
    EXPECT_EQ(refusal({3 * 1024, 64, 48}), "accepted");
    EXPECT_EQ(refusal({3 * 1024, 64, fully_associative}), "accepted");
    EXPECT_EQ(refusal({7, 1, 7}), "accepted");
    EXPECT_EQ(refusal({1, 1, 1}), "accepted");
}

}  // namespace
}  // namespace regather::cachesim
