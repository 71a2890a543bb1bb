// Sets as rows of stamps: drawn by hand after each touch, and by definition on every instruction set that the
// kernel is compiled for and this machine has.
#include "cachesim/lru/recency_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hwy/aligned_allocator.h>
#include <hwy/highway.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <vector>

#include "tests/cachesim/brute_force.h"

namespace regather::cachesim {
namespace {

using testing::ElementsAre;

class OnEachInstructionSet : public testing::Test {
protected:
    void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

/// Rows of one number of sets, empty, and what they counted.
struct Level {
    Level(std::uint32_t row, std::uint32_t set_bits, bool with_conflicts)
        : places(std::size_t{row} << set_bits),
          stamps(hwy::AllocateAligned<std::int32_t>(places)),
          misses(row) {
        std::fill_n(stamps.get(), places, empty_place);
        if (with_conflicts) conflicts.resize(row);
        rows = {stamps.get(), row, set_bits};
    }
    RowCounts counts() { return {misses.data(), conflicts.empty() ? nullptr : conflicts.data()}; }
    std::vector<std::int32_t> held() const { return {stamps.get(), stamps.get() + places}; }

    std::size_t places;
    hwy::AlignedFreeUniquePtr<std::int32_t[]> stamps;
    std::vector<std::uint64_t> misses, conflicts;
    RecencyRows rows{};
};

struct Stream {
    std::vector<std::uint32_t> line;
    std::vector<std::int32_t> before, now, distance, counted;

    void push(std::uint32_t l, std::int32_t b, std::int32_t n, std::int32_t d = last_stamp, bool c = true) {
        line.push_back(l << 6);
        before.push_back(b);
        now.push_back(n);
        distance.push_back(d);
        counted.push_back(c ? -1 : 0);
    }
    void through(std::vector<Level>& levels, bool with_distances, bool with_counted) const {
        std::vector<std::uint32_t> lines = line;
        lines.resize(line.size() + prefetched_ahead, 0xffffffffu);
        std::vector<RecencyRows> rows;
        std::vector<RowCounts> counts;
        for (Level& level : levels) {
            rows.push_back(level.rows);
            counts.push_back(level.counts());
        }
        touch_rows(rows,
                   {lines.data(), before.data(), now.data(), with_distances ? distance.data() : nullptr,
                    with_counted ? counted.data() : nullptr, line.size()},
                   counts);
    }
};

// One set of four places, which are the stamps, newest first; what caches of 1, 2, 3 and 4 ways have missed.
TEST_F(OnEachInstructionSet, TheRowAfterEachTouchIsTheOneDrawnByHand) {
    struct Step {
        const char* what;
        std::int32_t before, now;
        bool counted;
        std::vector<std::int32_t> row;
        std::vector<std::uint64_t> misses;
    };
    const std::vector<Step> steps{
        {"A, B, C and D come", never_touched, 2, true, {2, 1, 1, 1}, {1, 1, 1, 1}},
        {"B", never_touched, 3, true, {3, 2, 1, 1}, {2, 2, 2, 2}},
        {"C", never_touched, 4, true, {4, 3, 2, 1}, {3, 3, 3, 3}},
        {"D", never_touched, 5, true, {5, 4, 3, 2}, {4, 4, 4, 4}},
        {"D again: on top", 5, 6, true, {6, 4, 3, 2}, {4, 4, 4, 4}},
        {"B again, from the middle: C and D are above it", 3, 7, true, {7, 6, 4, 2}, {5, 5, 4, 4}},
        {"A again, from the end", 2, 8, true, {8, 7, 6, 4}, {6, 6, 5, 4}},
        {"E comes, to be touched once more: C, the oldest, goes",
         never_touched,
         11,
         true,
         {11, 8, 7, 6},
         {7, 7, 6, 5}},
        {"F comes, and E stays the newest: D goes", never_touched, 10, true, {11, 10, 8, 7}, {8, 8, 7, 6}},
        {"B from the end to below both", 7, 9, true, {11, 10, 9, 8}, {9, 9, 8, 6}},
        {"A, which stood last, to the front", 8, 12, true, {12, 11, 10, 9}, {10, 10, 9, 6}},
        {"C had gone", 4, 13, true, {13, 12, 11, 10}, {11, 11, 10, 7}},
        {"G is not counted", never_touched, 14, false, {14, 13, 12, 11}, {11, 11, 10, 7}},
        {"A is not counted", 12, 15, false, {15, 14, 13, 11}, {11, 11, 10, 7}},
        {"a line older than all stays out", never_touched, 10, false, {15, 14, 13, 11}, {11, 11, 10, 7}},
    };
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        std::vector<Level> level;
        level.emplace_back(4, 0, false);
        for (const Step& step : steps) {
            Stream stream;
            stream.push(99, step.before, step.now, last_stamp, step.counted);
            stream.through(level, false, !step.counted);
            ASSERT_EQ(level[0].held(), step.row) << step.what << ", " << hwy::TargetName(target);
            ASSERT_EQ(level[0].misses, step.misses) << step.what << ", " << hwy::TargetName(target);
        }
    }
}

// Two sets. Lines 0, 2, 4 and 0 again: three lines of set 0, so 1 and 2 ways miss the 0. Full caches of 2
// lines miss it, too, but one of 4 lines (two ways) does not. Then 1, the first of set 1, and 0: on top of
// its set, no miss, whatever came in between.
TEST_F(OnEachInstructionSet, AConflictIsAMissThatAFullCacheOfTheSizeDoesNotHave) {
    Stream stream;
    stream.push(0, never_touched, 2);
    stream.push(2, never_touched, 3);
    stream.push(4, never_touched, 4);
    stream.push(0, 2, 5, 2);
    stream.push(1, never_touched, 6);
    stream.push(0, 5, 7, 1);
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        std::vector<Level> level;
        level.emplace_back(4, 1, true);
        stream.through(level, true, false);
        EXPECT_THAT(level[0].misses, ElementsAre(5, 5, 4, 4)) << hwy::TargetName(target);
        EXPECT_THAT(level[0].conflicts, ElementsAre(0, 1, 0, 0)) << hwy::TargetName(target);
        EXPECT_THAT(level[0].held(), ElementsAre(7, 4, 3, 1, 6, 1, 1, 1)) << hwy::TargetName(target);
    }
}

/// Walks of different lines, each with the stamps of its last touches in another order than that of its first
/// ones.
Stream scattered(std::uint32_t universe, std::uint64_t seed) {
    Scatter scatter(seed);
    Stream stream;
    std::map<std::uint32_t, std::int32_t> last;
    for (std::int32_t base = first_stamp; stream.line.size() < 3000;) {
        std::vector<std::uint32_t> lines;
        for (std::uint64_t i = 1 + scatter.below(20); i > 0; --i)
            lines.push_back(static_cast<std::uint32_t>(scatter.below(1 + scatter.below(universe))));
        std::sort(lines.begin(), lines.end());
        lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
        std::vector<std::int32_t> nows(lines.size());
        std::iota(nows.begin(), nows.end(), base);
        for (std::size_t i = lines.size(); i > 1; --i) {
            std::swap(lines[i - 1], lines[scatter.below(i)]);
            std::swap(nows[i - 1], nows[scatter.below(i)]);
        }
        for (std::size_t i = 0; i < lines.size(); ++i) {
            std::int32_t& before = last[lines[i]];
            const auto newer = [&](const auto& other) { return other.second > before; };
            const auto distance = static_cast<std::int32_t>(std::count_if(last.begin(), last.end(), newer));
            stream.push(lines[i], before, nows[i], before == never_touched ? last_stamp : distance,
                        scatter.below(4) != 0);
            before = nows[i];
        }
        base += static_cast<std::int32_t>(lines.size());
    }
    return stream;
}

/// By definition: as deep as there are newer lines in the set; a conflict when a full cache of the size is
/// not as deep.
void count_by_definition(const Stream& stream, Level& level, bool with_counted) {
    std::vector<std::map<std::uint32_t, std::int32_t>> sets(std::size_t{1} << level.rows.set_bits);
    for (std::size_t i = 0; i < stream.line.size(); ++i) {
        auto& set = sets[(stream.line[i] >> 6) % sets.size()];
        const auto newer = [&](const auto& other) { return other.second > stream.before[i]; };
        const auto depth = static_cast<std::size_t>(std::count_if(set.begin(), set.end(), newer));
        const bool first = stream.before[i] == never_touched;
        for (std::size_t ways = 1; ways <= level.misses.size(); ++ways) {
            if ((with_counted && stream.counted[i] == 0) || (depth < ways && !first)) continue;
            ++level.misses[ways - 1];
            const bool full_hits =
                !first && static_cast<std::size_t>(stream.distance[i]) < ways * sets.size();
            if (!level.conflicts.empty()) level.conflicts[ways - 1] += full_hits ? 1 : 0;
        }
        set[stream.line[i]] = stream.now[i];
    }
    for (std::size_t s = 0; s < sets.size(); ++s) {
        std::vector<std::int32_t> stamps;
        for (const auto& [line, stamp] : sets[s]) stamps.push_back(stamp);
        std::sort(stamps.rbegin(), stamps.rend());
        stamps.resize(level.rows.row, empty_place);
        std::copy(stamps.begin(), stamps.end(), level.stamps.get() + s * level.rows.row);
    }
}

TEST_F(OnEachInstructionSet, AllCountByTheDefinition) {
    const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
    ASSERT_FALSE(targets.empty());
    for (const std::uint32_t row : {4u, 8u, 16u, 32u}) {
        const Stream stream = scattered(40 * row, row);
        for (const bool conflicts : {false, true})
            for (const bool counted : {false, true})
                for (std::uint32_t number = 1; number <= 5; ++number) {  // of levels side by side
                    std::vector<Level> expected;
                    for (std::uint32_t l = 0; l < number; ++l) {
                        expected.emplace_back(row, (3 * l + number) % 7, conflicts);
                        count_by_definition(stream, expected.back(), counted);
                    }
                    for (const std::int64_t target : targets) {
                        hwy::SetSupportedTargetsForTest(target);
                        std::vector<Level> levels;
                        for (const Level& level : expected)
                            levels.emplace_back(row, level.rows.set_bits, conflicts);
                        stream.through(levels, conflicts, counted);
                        for (std::size_t l = 0; l < levels.size(); ++l) {
                            ASSERT_EQ(levels[l].misses, expected[l].misses)
                                << hwy::TargetName(target) << ", " << row;
                            ASSERT_EQ(levels[l].conflicts, expected[l].conflicts)
                                << hwy::TargetName(target) << ", " << row;
                            ASSERT_EQ(levels[l].held(), expected[l].held())
                                << hwy::TargetName(target) << ", " << row;
                        }
                    }
                }
    }
}

TEST_F(OnEachInstructionSet, ATouchIsCountedOnTopOfWhatWasCounted) {
    std::vector<Level> level;
    level.emplace_back(8, 0, false);
    level[0].misses.assign(8, std::uint64_t{1} << 40);
    Stream stream;
    stream.push(0, never_touched, 2);
    stream.through(level, false, false);
    EXPECT_EQ(level[0].misses, std::vector<std::uint64_t>(8, (std::uint64_t{1} << 40) + 1));
}

}  // namespace
}  // namespace regather::cachesim
