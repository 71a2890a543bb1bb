#include "cachesim/lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cachesim/distinct.h"

namespace regather::cachesim {
namespace {

using testing::ElementsAre;

std::vector<std::uint64_t> lines_of(std::uint64_t address, std::uint64_t bytes, std::uint32_t line_bytes) {
    std::vector<Line> lines;
    append_lines(lines, address, bytes, line_bytes);
    std::vector<std::uint64_t> numbers;
    for (const Line line : lines) numbers.push_back(static_cast<std::uint64_t>(line));
    return numbers;
}

TEST(Lines, ARangeInsideALineTouchesIt) {
    EXPECT_THAT(lines_of(0, 1, 64), ElementsAre(0));
    EXPECT_THAT(lines_of(0, 64, 64), ElementsAre(0));
    EXPECT_THAT(lines_of(127, 1, 64), ElementsAre(1));
    EXPECT_THAT(lines_of(20 * 32, 20, 128), ElementsAre(5));
}

TEST(Lines, ARangeThatStraddlesTouchesAll) {
    EXPECT_THAT(lines_of(63, 2, 64), ElementsAre(0, 1));
    EXPECT_THAT(lines_of(20 * 6, 20, 128), ElementsAre(0, 1));  // the 7th photon of 20 bytes: 120 to 139
    EXPECT_THAT(lines_of(63, 66, 64), ElementsAre(0, 1, 2));
    EXPECT_THAT(lines_of(10, 3, 1), ElementsAre(10, 11, 12));
}

TEST(Lines, TheLastBytesOfTheAddressSpaceHaveLines) {
    constexpr std::uint64_t last = ~std::uint64_t{0};
    EXPECT_THAT(lines_of(last, 1, 1), ElementsAre(last));
    EXPECT_THAT(lines_of(last - 64, 65, 64), ElementsAre(last / 64 - 1, last / 64));
    EXPECT_THAT(lines_of(last - 2, 3, 1), ElementsAre(last - 2, last - 1, last));
}

TEST(Lines, NoBytesTouchNothing) {
    EXPECT_THAT(lines_of(64, 0, 64), ElementsAre());
}

TEST(DistinctLines, CountsEachLineOnce) {
    DistinctLines distinct;
    EXPECT_EQ(distinct.count(), 0u);
    distinct.add(std::vector{Line{5}, Line{5}, Line{63}, Line{64}});
    EXPECT_EQ(distinct.count(), 3u);
    distinct.add(std::vector{Line{64}, Line{100'000}, Line{5}, Line{0}});
    EXPECT_EQ(distinct.count(), 5u);
}

TEST(DistinctLines, CountsLinesOfAnyNumber) {
    DistinctLines distinct;
    constexpr std::uint64_t last = ~std::uint64_t{0}, bitmap_end = std::uint64_t{1} << 28;
    for (int round = 0; round < 2; ++round)
        distinct.add(std::vector{Line{last}, Line{last - 1}, Line{bitmap_end - 1}, Line{bitmap_end},
                                 Line{1ull << 40}, Line{0}});
    EXPECT_EQ(distinct.count(), 6u);
}

}  // namespace
}  // namespace regather::cachesim
