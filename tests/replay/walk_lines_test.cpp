// A walk's lines and their first touches: drawn by hand, and by looking through the touches.
#include "replay/walk_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <numeric>

#include "spatial/photons/left_balanced.h"

namespace regather::replay {
namespace {

using cachesim::Line;
using testing::ElementsAre;

std::vector<std::uint64_t> numbers(std::span<const Line> lines) {
    std::vector<std::uint64_t> found;
    for (const Line line : lines) found.push_back(static_cast<std::uint64_t>(line));
    return found;
}

std::vector<std::uint64_t> touches(WalkLines& lines, const std::vector<std::uint32_t>& slots) {
    return numbers(lines.touches(slots));
}

struct First {
    std::vector<std::uint64_t> lines;
    std::vector<std::uint32_t> last_rank;
    friend bool operator==(const First&, const First&) = default;
};
First first(WalkLines& lines, const std::vector<std::uint32_t>& slots) {
    const WalkLines::First found = lines.first(lines.touches(slots));
    return {numbers(found.lines), {found.last_rank.begin(), found.last_rank.end()}};
}

// Nodes of 20 bytes: 1 at 0-19, 2 at 20-39, 3 at 40-59, 4 at 60-79, 5 at 80-99, 6 at 100-119, 7 at 120-139.
TEST(WalkLines, TouchesOnLinesOf64BytesAreThoseDrawnByHand) {
    const Layout layout = heap_20(spatial::LeftBalanced(7));
    WalkLines lines(layout, 64);
    EXPECT_EQ(lines.line_bytes(), 64u);
    EXPECT_THAT(touches(lines, {1, 2, 3}), ElementsAre(0, 0, 0));
    EXPECT_THAT(touches(lines, {4}), ElementsAre(0, 1));  // over the edge
    EXPECT_THAT(touches(lines, {1, 4, 2, 5, 7, 6}), ElementsAre(0, 0, 1, 0, 1, 1, 2, 1));
    EXPECT_THAT(touches(lines, {}), ElementsAre());
}

TEST(WalkLines, TouchesOnShortLinesAreThoseDrawnByHand) {
    const Layout layout = heap_20(spatial::LeftBalanced(7));
    WalkLines sixteen(layout, 16), eight(layout, 8), four(layout, 4);
    EXPECT_THAT(touches(sixteen, {1, 2, 3, 4, 5}), ElementsAre(0, 1, 1, 2, 2, 3, 3, 4, 5, 6));
    EXPECT_THAT(touches(eight, {1, 2, 3}), ElementsAre(0, 1, 2, 2, 3, 4, 5, 6, 7));
    EXPECT_THAT(touches(four, {2, 1}), ElementsAre(5, 6, 7, 8, 9, 0, 1, 2, 3, 4));
}

TEST(WalkLines, ALayoutWithABaseAndGaps) {
    // Nodes at 1036-1059, 1068-1091: lines of 16 bytes from 1024 (64), 1040 (65), 1056 (66), 1072 (67), 1088
    // (68) on.
    const Layout layout("gaps", spatial::LeftBalanced(2), 1036, 32, 24);
    WalkLines lines(layout, 16);
    EXPECT_THAT(touches(lines, {1, 2, 1}), ElementsAre(64, 65, 66, 66, 67, 68, 64, 65, 66));
    EXPECT_EQ(first(lines, {1, 2, 1}), (First{{64, 65, 66, 67, 68}, {2, 3, 4, 0, 1}}));
}

//             7    4    1        7    1    4         1    7    1
// touches   1, 2  0, 1  0      1, 2   0   0, 1       0   1, 2  0
// last      .  2   .  1 0      .  2   .   0  1       .   1  2  0
// first     1, 2, 0            1, 2, 0               0, 1, 2
// rank      1  0  2            2  0  1               2  0  1
TEST(WalkLines, FirstTouchesAndTheRanksOfTheLastAreThoseDrawnByHand) {
    const Layout layout = heap_20(spatial::LeftBalanced(7));
    WalkLines lines(layout, 64);
    EXPECT_EQ(first(lines, {7, 4, 1}), (First{{1, 2, 0}, {1, 0, 2}}));
    EXPECT_EQ(first(lines, {7, 1, 4}), (First{{1, 2, 0}, {2, 0, 1}}));
    EXPECT_EQ(first(lines, {1, 7, 1}), (First{{0, 1, 2}, {2, 0, 1}}));
    EXPECT_EQ(first(lines, {}), (First{}));
    EXPECT_EQ(first(lines, {6}), (First{{1}, {0}}));  // a walk begins without the lines of those before
}

First by_looking(const std::vector<std::uint64_t>& touches) {
    First found;
    std::vector<std::size_t> last;  // place of each one's last touch
    for (const std::uint64_t line : touches)
        if (std::find(found.lines.begin(), found.lines.end(), line) == found.lines.end())
            found.lines.push_back(line);
    for (const std::uint64_t line : found.lines)
        last.push_back(static_cast<std::size_t>(std::find(touches.rbegin(), touches.rend(), line).base() -
                                                touches.begin()));
    for (const std::size_t place : last)
        found.last_rank.push_back(static_cast<std::uint32_t>(
            std::count_if(last.begin(), last.end(), [&](std::size_t p) { return p < place; })));
    return found;
}

TEST(WalkLines, EqualsLookingAtEveryByte) {
    ASSERT_TRUE(rc::check("walks one after the other, in any layout and size of line", [] {
        const auto photons = *rc::gen::inRange<std::uint32_t>(1, 120);
        const auto used = *rc::gen::inRange<std::uint32_t>(1, 70);
        const std::uint32_t stride = used + *rc::gen::element(0u, 1u, 12u, 100u);
        const auto base = *rc::gen::element<std::uint64_t>(0, 1, 4095, 4096, std::uint64_t{1} << 40);
        const spatial::LeftBalanced tree(photons);
        const Layout layout("any", tree, base, stride, used);
        const std::uint32_t line_bytes = 1u << *rc::gen::inRange(0, 9);
        WalkLines lines(layout, line_bytes);
        for (int walks = *rc::gen::inRange(0, 6); walks > 0; --walks) {
            auto slots = *rc::gen::container<std::vector<std::uint32_t>>(
                rc::gen::inRange<std::uint32_t>(1, photons + 1));
            if (*rc::gen::arbitrary<bool>()) slots.push_back(photons);  // the last line
            std::vector<std::uint64_t> expected;
            for (const std::uint32_t slot : slots) {
                const std::uint64_t start = base + std::uint64_t{slot - 1} * stride;
                for (std::uint64_t byte = start; byte < start + used; ++byte)
                    if (byte == start || byte % line_bytes == 0) expected.push_back(byte / line_bytes);
            }
            RC_ASSERT(touches(lines, slots) == expected);
            RC_ASSERT(first(lines, slots) == by_looking(expected));
        }
    }));
}

TEST(WalkLines, ALongWalkAfterAShortOne) {
    const Layout layout = heap_20(spatial::LeftBalanced(50'000));
    WalkLines lines(layout, 32);
    std::vector<std::uint32_t> slots(3);
    for (const std::size_t length : {3, 50'000, 64, 63, 128}) {
        slots.resize(length);
        for (std::size_t i = 0; i < length; ++i) slots[i] = static_cast<std::uint32_t>(length - i);
        // Downwards through whole lines of 32 bytes: each one's touches follow one another.
        const First found = first(lines, slots);
        const std::uint64_t last_line = (length * 20 - 1) / 32;
        ASSERT_EQ(found.lines.size(), last_line + 1);
        ASSERT_EQ(*std::max_element(found.lines.begin(), found.lines.end()), last_line);
        std::vector<std::uint32_t> ranks = found.last_rank;
        std::sort(ranks.begin(), ranks.end());
        std::vector<std::uint32_t> expected(last_line + 1);
        std::iota(expected.begin(), expected.end(), 0u);
        ASSERT_EQ(ranks, expected);
    }
}

}  // namespace
}  // namespace regather::replay
