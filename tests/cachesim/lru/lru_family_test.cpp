#include "cachesim/lru/lru_family.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <list>
#include <map>
#include <set>

#include "tests/cachesim/brute_force.h"
#include "trace/error.h"

namespace regather::cachesim {
namespace {

using testing::ElementsAre;

constexpr std::uint32_t line_bytes = 64;

/// Misses by definition, and Hill's classes: each cache simulated for itself, the fully associative one
/// beside it.
struct BruteForce {
    std::uint64_t misses = 0, conflicts = 0;
};
BruteForce brute_force(std::span<const Line> lines, std::uint64_t sets, std::uint32_t ways,
                       const std::vector<bool>& counted = {}) {
    BruteForceLru cache({sets * ways * line_bytes, line_bytes, ways});
    BruteForceLru full({sets * ways * line_bytes, line_bytes, fully_associative});
    BruteForce result;
    std::uint64_t cache_misses = 0, full_misses = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        cache.access(lines[i], trace::Region::other, Access::read);
        full.access(lines[i], trace::Region::other, Access::read);
        const bool missed = cache.stats[2].misses != cache_misses,
                   full_missed = full.stats[2].misses != full_misses;
        cache_misses = cache.stats[2].misses;
        full_misses = full.stats[2].misses;
        if (!counted.empty() && !counted[i]) continue;
        result.misses += missed ? 1 : 0;
        result.conflicts += missed && !full_missed ? 1 : 0;
    }
    return result;
}

const std::vector<FamilyLevel> levels{{1, 16}, {2, 32}, {4, 3},   {8, 8},
                                      {16, 1}, {64, 4}, {256, 2}, {1024, 4}};

std::vector<Line> some_lines(std::uint64_t universe, std::uint64_t base) {
    const auto numbers =
        *rc::gen::container<std::vector<std::uint32_t>>(rc::gen::inRange<std::uint32_t>(0, 1u << 30));
    std::vector<Line> lines;
    for (const std::uint32_t number : numbers) lines.push_back(Line{base + number % universe});
    return lines;
}

void expect_brute_force(FamilyCounts counts, std::span<const Line> lines) {
    RC_ASSERT(counts.accesses == lines.size());
    RC_ASSERT(counts.compulsory == std::set<Line>(lines.begin(), lines.end()).size());
    for (const FamilyLevel& level : levels)
        for (std::uint32_t ways = 1; ways <= level.ways; ++ways) {
            const BruteForce expected = brute_force(lines, level.sets, ways);
            RC_ASSERT(counts.misses(level.sets, ways) == expected.misses);
            RC_ASSERT(counts.conflicts(level.sets, ways) == expected.conflicts);
        }
    for (std::uint64_t size = 1; size < 70; ++size)
        RC_ASSERT(counts.full_misses(size) == brute_force(lines, 1, static_cast<std::uint32_t>(size)).misses);
}

TEST(LruFamily, CountsWhatEachCacheAloneCounts) {
    ASSERT_TRUE(rc::check("low and high line numbers, few and many lines", [] {
        const auto universe = *rc::gen::element<std::uint64_t>(3, 12, 40, 300, 3000);
        const auto base = *rc::gen::element<std::uint64_t>(0, (1u << 24) - 5, std::uint64_t{1} << 57);
        const std::vector<Line> lines = some_lines(universe, base);
        LruFamily family({.levels = levels});
        family.access(lines);
        expect_brute_force(family.counts(), lines);
    }));
}

// 2 sets, even lines in the first:
//        set 0      set 1      fully associative (newest first)
// 0 m    0          -          0
// 1 m    0          1          1 0
// 2 m    2 0        1          2 1 0
// 0 h1   0 2        1          0 2 1      distance 2
// 4 m    4 0 2      1          4 0 2 1
// 2 h2   2 4 0      1          2 4 0 1    distance 2
// 1 h0   2 4 0      1          1 2 4 0    distance 3
TEST(LruFamily, DepthsOfSetsDrawnByHand) {
    LruFamily family({.levels = {{2, 4}}});
    for (const std::uint64_t line : {0, 1, 2, 0, 4, 2, 1}) family.access(std::vector<Line>{Line{line}});
    const FamilyCounts counts = family.counts();
    EXPECT_EQ(counts.compulsory, 4u);
    EXPECT_THAT(counts.by_distance, ElementsAre(0, 0, 2, 1));
    // 1 way: only the last access hits. 2 ways: the 0 at depth 1 too. 3 ways: the 2 as well.
    EXPECT_THAT(counts.levels[0].misses, ElementsAre(6, 5, 4, 4));
    // A conflict misses its set but not a full cache of 2 w lines: 2 lines would miss all; 4 lines keep all
    // three, of which two ways lose the 2; from 6 lines on the sets keep all.
    EXPECT_THAT(counts.levels[0].conflicts, ElementsAre(0, 1, 0, 0));
}

/// Walks over few lines, so that they meet again and again.
std::vector<std::vector<Line>> some_walks() {
    const auto numbers = *rc::gen::container<std::vector<std::vector<std::uint8_t>>>(
        rc::gen::arbitrary<std::vector<std::uint8_t>>());
    std::vector<std::vector<Line>> walks;
    for (const auto& walk : numbers) {
        walks.emplace_back();
        for (const std::uint8_t line : walk) walks.back().push_back(Line{line % 4u * 256 + line % 31u});
    }
    return walks;
}

void access_first(LruFamily& family, const std::vector<Line>& walk) {
    std::vector<Line> first;
    for (const Line line : walk)
        if (std::find(first.begin(), first.end(), line) == first.end()) first.push_back(line);
    std::vector<Line> last;
    for (auto line = walk.rbegin(); line != walk.rend(); ++line)
        if (std::find(last.begin(), last.end(), *line) == last.end()) last.insert(last.begin(), *line);
    std::vector<std::uint32_t> rank;
    for (const Line line : first)
        rank.push_back(static_cast<std::uint32_t>(std::find(last.begin(), last.end(), line) - last.begin()));
    family.access_first(first, rank);
}

TEST(LruFamily, FirstTouchesAndRevisitsOfWalksMakeUpTheStream) {
    ASSERT_TRUE(rc::check("in any order of the walks, revisits counted in capture order", [] {
        const auto walks = some_walks();
        LruFamily again({.levels = levels});
        for (const auto& walk : walks) again.revisit(walk);
        std::vector<std::size_t> order(walks.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
        const auto shift = *rc::gen::inRange<std::size_t>(0, 100);
        std::rotate(order.begin(),
                    order.begin() + static_cast<std::ptrdiff_t>(order.empty() ? 0 : shift % order.size()),
                    order.end());

        LruFamily first({.levels = levels});
        std::vector<Line> stream;
        for (const std::size_t i : order) {
            access_first(first, walks[i]);
            stream.insert(stream.end(), walks[i].begin(), walks[i].end());
        }
        FamilyCounts sum = again.counts();
        RC_ASSERT(sum.compulsory == 0u);
        sum += first.counts();
        expect_brute_force(sum, stream);
    }));
}

TEST(LruFamily, NumbersItsStampsAnewWithoutATrace) {
    // 2^16 stamps are the fewest: 200,000 accesses to 20,000 lines use them up several times, and 50,000
    // lines make more.
    Scatter scatter(7);
    std::vector<Line> lines;
    for (int i = 0; i < 200'000; ++i) lines.push_back(Line{scatter.below(i < 120'000 ? 20'000 : 50'000)});
    LruFamily few({.levels = levels, .stamps = 1}),
        many({.levels = levels, .stamps = std::uint64_t{1} << 20});
    for (std::size_t i = 0; i < lines.size(); i += 1000) few.access(std::span(lines).subspan(i, 1000));
    many.access(lines);
    EXPECT_EQ(few.counts(), many.counts());
    LruCache cache({.size_bytes = 64 * 4 * line_bytes, .line_bytes = line_bytes, .ways = 4});
    cache.access(lines, trace::Region::other);
    EXPECT_EQ(few.counts().misses(64, 4), cache.total().misses);
    LruCache full({.size_bytes = 8192 * line_bytes, .line_bytes = line_bytes, .ways = fully_associative});
    full.access(lines, trace::Region::other);
    EXPECT_EQ(few.counts().full_misses(8192), full.total().misses);
}

TEST(LruFamily, MoreWaysNeverMissMoreAndTheClassesAddUp) {
    Scatter scatter(3);
    std::vector<Line> lines;
    for (int i = 0; i < 50'000; ++i) lines.push_back(Line{scatter.below(10) * scatter.below(90)});
    LruFamily family({.levels = levels});
    family.access(lines);
    const FamilyCounts& counts = family.counts();
    for (const FamilyCounts::Level& level : counts.levels)
        for (std::size_t w = 0; w < level.misses.size(); ++w) {
            EXPECT_LE(level.misses[w], level.misses[w == 0 ? 0 : w - 1]);
            EXPECT_GE(level.misses[w], counts.compulsory + level.conflicts[w]);
        }
}

TEST(LruFamily, CountsHold64BitsAndAddUp) {
    LruFamily family({.levels = levels});
    Scatter scatter(9);
    std::vector<Line> lines;
    for (int i = 0; i < 3000; ++i) lines.push_back(Line{scatter.below(400)});
    family.access(lines);
    const FamilyCounts once = family.counts();
    FamilyCounts sum;
    sum += once;
    EXPECT_EQ(sum, once);
    for (int doubled = 0; doubled < 40; ++doubled) sum += FamilyCounts(sum);
    constexpr std::uint64_t times = std::uint64_t{1} << 40;
    EXPECT_EQ(sum.accesses, 3000 * times);
    EXPECT_EQ(sum.compulsory, std::set<Line>(lines.begin(), lines.end()).size() * times);
    for (const FamilyLevel& level : levels)
        for (std::uint32_t ways = 1; ways <= level.ways; ++ways) {
            EXPECT_EQ(sum.misses(level.sets, ways), once.misses(level.sets, ways) * times);
            EXPECT_EQ(sum.conflicts(level.sets, ways), once.conflicts(level.sets, ways) * times);
        }
    for (const std::uint64_t size : {1, 20, 300, 500})
        EXPECT_EQ(sum.full_misses(size), once.full_misses(size) * times);
}

TEST(LruFamily, CountsOfTwoFamiliesDoNotAddUp) {
    FamilyCounts sum = LruFamily({.levels = {{2, 4}}}).counts();
    EXPECT_THROW(sum += LruFamily({.levels = {{4, 4}}}).counts(), std::logic_error);
    EXPECT_THROW(sum.misses(2, 5), std::logic_error);
    EXPECT_THROW(sum.misses(2, 0), std::logic_error);
    EXPECT_THROW(sum.misses(4, 1), std::logic_error);
}

/// Hits near and far, in lines of which some meet in every set.
std::vector<Line> skewed_lines(std::uint64_t base, std::size_t count = 20'000) {
    Scatter scatter(21);
    std::vector<Line> lines(count);
    for (Line& line : lines)
        line = Line{base + scatter.below(1 + scatter.below(3000)) * (1 + 255 * scatter.below(2))};
    return lines;
}

TEST(LruFamily, ALevelDoesNotKnowOfTheOthersNorOfTheirOrder) {
    const std::vector<Line> lines = skewed_lines(0);
    LruFamily all({.levels = levels});
    all.access(lines);
    const FamilyCounts together = all.counts();

    std::vector<FamilyLevel> backwards(levels.rbegin(), levels.rend());
    std::rotate(backwards.begin(), backwards.begin() + 3, backwards.end());
    LruFamily other({.levels = backwards});
    other.access(lines);
    EXPECT_EQ(other.counts().by_distance, together.by_distance);
    for (const FamilyLevel& level : levels) {
        LruFamily one({.levels = {level}});
        one.access(lines);
        EXPECT_EQ(one.counts().compulsory, together.compulsory);
        for (std::uint32_t ways = 1; ways <= level.ways; ++ways) {
            EXPECT_EQ(one.counts().misses(level.sets, ways), together.misses(level.sets, ways));
            EXPECT_EQ(one.counts().conflicts(level.sets, ways), together.conflicts(level.sets, ways));
            EXPECT_EQ(other.counts().misses(level.sets, ways), together.misses(level.sets, ways));
            EXPECT_EQ(other.counts().conflicts(level.sets, ways), together.conflicts(level.sets, ways));
        }
    }
}

TEST(LruFamily, ACallOrManyAndCountsReadInBetweenAreTheSame) {
    const std::vector<Line> lines = skewed_lines(0, 5000);
    LruFamily whole({.levels = levels}), by_line({.levels = levels});
    whole.access(lines);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        by_line.access(std::span(lines).subspan(i, 1));
        if (i % 7 == 0) {
            ASSERT_EQ(by_line.counts().accesses, i + 1);
        }
    }
    EXPECT_EQ(by_line.counts(), whole.counts());
    whole.access({});
    whole.access_first({}, {});
    whole.revisit({});
    EXPECT_EQ(by_line.counts(), whole.counts());
}

TEST(LruFamily, MissesAreTheSameWithoutDistancesOrConflicts) {
    const std::vector<Line> lines = skewed_lines(0);
    LruFamily all({.levels = levels}), no_conflicts({.levels = levels, .conflicts = false}),
        bare({.levels = levels, .distances = false, .conflicts = false, .stamps = 1});
    for (LruFamily* family : {&all, &no_conflicts, &bare}) family->access(lines);
    EXPECT_EQ(no_conflicts.counts().by_distance, all.counts().by_distance);
    EXPECT_TRUE(bare.counts().by_distance.empty());
    for (LruFamily* family : {&no_conflicts, &bare}) {
        EXPECT_EQ(family->counts().accesses, all.counts().accesses);
        EXPECT_EQ(family->counts().compulsory, all.counts().compulsory);
        for (std::size_t l = 0; l < levels.size(); ++l) {
            EXPECT_EQ(family->counts().levels[l].misses, all.counts().levels[l].misses);
            EXPECT_TRUE(family->counts().levels[l].conflicts.empty());
        }
    }
}

TEST(LruFamily, WhereLinesLieDoesNotMatterAsLongAsTheirSetsAreTheSame) {
    LruFamily low({.levels = levels});
    low.access(skewed_lines(0));
    for (const std::uint64_t base :
         {std::uint64_t{1} << 24, std::uint64_t{1} << 32, std::uint64_t{1} << 63}) {
        LruFamily high({.levels = levels});
        high.access(skewed_lines(base));
        EXPECT_EQ(high.counts(), low.counts()) << base;
    }
}

TEST(LruFamily, TheLastLineIsALineLikeAnyOther) {
    const std::vector<Line> lines{Line{~std::uint64_t{0}}, Line{~std::uint64_t{0}},
                                  Line{~std::uint64_t{0} - 256}};
    LruFamily family({.levels = levels});
    family.access(lines);
    for (const FamilyLevel& level : levels)
        EXPECT_EQ(family.counts().misses(level.sets, level.ways), 2u) << level.sets;
}

/// Few stamps, so that they are used up again and again between walks whose newest lines were left out of a
/// filter.
TEST(LruFamily, WalksOutlastTheirStamps) {
    Scatter scatter(31);
    LruFamily few({.levels = levels, .stamps = 1}), bare({.levels = levels, .distances = false, .stamps = 1}),
        again({.levels = levels, .stamps = 1});
    LruFamily whole({.levels = levels});
    for (int w = 0; w < 6000; ++w) {
        std::vector<Line> walk;
        for (std::uint64_t i = 20 + scatter.below(20); i > 0; --i)
            walk.push_back(Line{scatter.below(1 + scatter.below(w % 50 == 0 ? 40'000 : 700))});
        access_first(few, walk);
        access_first(bare, walk);
        again.revisit(walk);
        whole.access(walk);
    }
    FamilyCounts sum = few.counts();
    sum += again.counts();
    EXPECT_EQ(sum, whole.counts());
    for (std::size_t l = 0; l < levels.size(); ++l)
        EXPECT_EQ(bare.counts().levels[l].misses, few.counts().levels[l].misses);
}

TEST(LruFamily, MoreLinesThanStampsInAnEndlessCircle) {
    // 100,000 lines round and round: the next one is always the oldest, so all are missed or, with one line
    // more, none.
    constexpr std::uint64_t number = 100'000, rounds = 4;
    for (const std::uint64_t base : {std::uint64_t{0}, std::uint64_t{1} << 40}) {
        LruFamily family({.levels = {{1, 32}, {1024, 32}, {std::uint64_t{1} << 17, 1}}, .stamps = 1});
        std::vector<Line> lines;
        for (std::uint64_t i = 0; i < number; ++i) lines.push_back(Line{base + i});
        for (std::uint64_t round = 0; round < rounds; ++round) family.access(lines);
        const FamilyCounts& counts = family.counts();
        EXPECT_EQ(counts.full_misses(number - 1), rounds * number);
        EXPECT_EQ(counts.full_misses(number), number);
        EXPECT_EQ(counts.misses(1, 32), rounds * number);
        EXPECT_EQ(counts.misses(1024, 32), rounds * number);  // 97 or 98 lines a set
        EXPECT_EQ(counts.misses(std::uint64_t{1} << 17, 1), number);
        EXPECT_EQ(counts.conflicts(1024, 32), 0u);
    }
}

TEST(LruFamily, WalksOfManyThousandLines) {
    Scatter scatter(17);
    for (const std::uint64_t base : {std::uint64_t{0}, std::uint64_t{1} << 40}) {
        LruFamily first({.levels = levels}), again({.levels = levels}), whole({.levels = levels});
        for (int w = 0; w < 3; ++w) {
            std::vector<Line> walk;
            for (int i = 0; i < 7000; ++i) walk.push_back(Line{base + scatter.below(6000)});
            access_first(first, walk);
            again.revisit(walk);
            whole.access(walk);
        }
        FamilyCounts sum = first.counts();
        sum += again.counts();
        EXPECT_EQ(sum, whole.counts());
    }
}

TEST(LruFamily, RefusesImpossibleLevels) {
    EXPECT_THROW(LruFamily({.levels = {{3, 1}}}), trace::UsageError);
    EXPECT_THROW(LruFamily({.levels = {{0, 1}}}), trace::UsageError);
    EXPECT_THROW(LruFamily({.levels = {{2, 0}}}), trace::UsageError);
    EXPECT_THROW(LruFamily({.levels = {{2, 33}}}), trace::UsageError);
}

}  // namespace
}  // namespace regather::cachesim
