// The stamps of lines against a map: in the table of low lines, above it, and at the border.
#include "cachesim/lru/line_stamps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <unordered_map>

#include "tests/cachesim/brute_force.h"

namespace regather::cachesim {
namespace {

constexpr std::uint64_t border = std::uint64_t{1} << 24;

class Compared {
public:
    /// Whether the line has the stamps that it was given last; gives it others.
    bool touch(std::uint64_t line) {
        Stamps& stamps = stamps_.of(Line{line});
        std::pair<std::int32_t, std::int32_t>& expected = map_[line];
        const bool equal = std::pair(stamps.all, stamps.filtered) == expected;
        ++next_;
        stamps = {next_, next_ % 3};
        expected = {next_, next_ % 3};
        return equal;
    }
    /// Whether going through all lines meets each one once.
    bool holds_all() {
        std::vector<std::pair<std::int32_t, std::int32_t>> met, expected;
        stamps_.for_each([&](const Stamps& stamps) {
            if (stamps.all != 0) met.emplace_back(stamps.all, stamps.filtered);
        });
        for (const auto& [line, stamps] : map_) expected.push_back(stamps);
        std::sort(met.begin(), met.end());
        std::sort(expected.begin(), expected.end());
        return met == expected;
    }
    LineStamps& stamps() { return stamps_; }

private:
    LineStamps stamps_;
    std::unordered_map<std::uint64_t, std::pair<std::int32_t, std::int32_t>> map_;
    std::int32_t next_ = 0;
};

TEST(LineStamps, EqualAMap) {
    ASSERT_TRUE(rc::check("low lines, and those from 2^24 on up to the last", [] {
        Compared compared;
        const auto choices = *rc::gen::arbitrary<std::vector<std::uint32_t>>();
        for (const std::uint32_t choice : choices) {
            const std::uint64_t bases[] = {
                0, 5000, border, std::uint64_t{1} << 32, std::uint64_t{5} << 40, ~std::uint64_t{0} - 31};
            RC_ASSERT(compared.touch(bases[choice % std::size(bases)] + (choice >> 8) % 32));
        }
        RC_ASSERT(compared.holds_all());
    }));
}

TEST(LineStamps, TheBorderIsNoSeam) {
    Compared compared;
    for (int turn = 0; turn < 3; ++turn)
        for (std::uint64_t line = border - 3; line < border + 3; ++line)
            EXPECT_TRUE(compared.touch(line)) << line;
    EXPECT_TRUE(compared.holds_all());
}

TEST(LineStamps, ManyHighLinesKeepTheirsWhileTheTableGrows) {
    // 40,000 lines are ten times the first table; multiples of 2^44 and lines side by side meet in it
    // differently.
    Scatter scatter(5);
    Compared compared;
    std::vector<std::uint64_t> lines;
    for (std::uint64_t i = 0; i < 40'000; ++i)
        lines.push_back(i % 3 == 0   ? border + i
                        : i % 3 == 1 ? i << 44
                                     : (std::uint64_t{1} << 63) + scatter.below(1u << 31));
    for (std::size_t i = 0; i < lines.size(); ++i) {
        ASSERT_TRUE(compared.touch(lines[i]));
        ASSERT_TRUE(compared.touch(lines[scatter.below(i + 1)]));
    }
    for (const std::uint64_t line : lines) ASSERT_TRUE(compared.touch(line));
    EXPECT_TRUE(compared.holds_all());
}

TEST(LineStamps, LowLinesStandInTheTable) {
    Compared compared;
    EXPECT_TRUE(compared.touch(7));
    EXPECT_TRUE(compared.stamps().low(std::vector<Line>{Line{3}, Line{20'000}, Line{7}}));
    EXPECT_EQ(compared.stamps().table()[7].all, 1);
    EXPECT_EQ(compared.stamps().table()[20'000].all, 0);
    compared.stamps().table()[20'000] = {9, 8};
    EXPECT_EQ(compared.stamps().of(Line{20'000}).all, 9);
    EXPECT_EQ(compared.stamps().of(Line{20'000}).filtered, 8);
    EXPECT_FALSE(compared.stamps().low(std::vector<Line>{Line{3}, Line{border}}));
    EXPECT_FALSE(compared.stamps().low(std::vector<Line>{Line{~std::uint64_t{0}}}));
    EXPECT_TRUE(compared.stamps().low({}));
}

}  // namespace
}  // namespace regather::cachesim
