// The bitmap of stamps against a sorted set, above all where its three sizes of count begin and end.
#include "cachesim/lru/stamp_bits.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <array>
#include <iterator>
#include <set>

namespace regather::cachesim {
namespace {

constexpr std::uint32_t word = 64, group = 2048, block = 65536;

std::uint32_t above(const std::set<std::uint32_t>& stamps, std::uint32_t stamp) {
    return static_cast<std::uint32_t>(std::distance(stamps.upper_bound(stamp), stamps.end()));
}

std::uint32_t below(const std::set<std::uint32_t>& stamps, std::uint32_t stamp) {
    return static_cast<std::uint32_t>(std::distance(stamps.begin(), stamps.lower_bound(stamp)));
}

/// Beside the borders of words, groups and blocks, and the first and the last; or anywhere.
std::uint32_t some_stamp(std::uint32_t capacity) {
    if (*rc::gen::inRange(0, 3) == 0) return *rc::gen::inRange<std::uint32_t>(0, capacity);
    const std::uint32_t size = *rc::gen::element(word, group, block, capacity);
    const std::uint32_t border = size * *rc::gen::inRange<std::uint32_t>(0, capacity / size + 1);
    const std::uint32_t beside = border + *rc::gen::inRange<std::uint32_t>(0, 4);
    return std::clamp(beside, 2u, capacity + 1) - 2;
}

void expect_equal(const StampBits& bits, const std::set<std::uint32_t>& stamps, std::uint32_t stamp) {
    const auto last = static_cast<std::uint32_t>(bits.capacity() - 1);
    const std::uint32_t newest = std::max(stamp, stamps.empty() ? 0 : *stamps.rbegin());
    RC_ASSERT(bits.above(stamp, newest) == above(stamps, stamp));
    RC_ASSERT(bits.above(stamp, last) == above(stamps, stamp));
    RC_ASSERT(bits.count() == stamps.size());
}

TEST(StampBits, EqualASortedSet) {
    ASSERT_TRUE(rc::check("after every step", [] {
        const std::uint32_t capacity = block * *rc::gen::element(1u, 2u, 4u);
        StampBits bits(capacity);
        std::set<std::uint32_t> stamps;
        RC_ASSERT(bits.capacity() == capacity);
        for (int steps = *rc::gen::inRange(0, 40); steps > 0; --steps) {
            const std::uint32_t stamp = some_stamp(capacity);
            if (*rc::gen::inRange(0, 4) == 0) {
                const auto next = stamps.lower_bound(stamp);
                const std::uint32_t room = (next == stamps.end() ? capacity : *next) - stamp;
                const std::uint32_t longest = *rc::gen::element(3u, word, 2 * word + 1, 3 * group, 2 * block);
                const std::uint32_t count = *rc::gen::inRange<std::uint32_t>(0, std::min(room, longest) + 1);
                bits.set_range(stamp, count);
                for (std::uint32_t i = 0; i < count; ++i) stamps.insert(stamp + i);
            } else if (stamps.contains(stamp)) {
                bits.clear(stamp);
                stamps.erase(stamp);
            } else {
                bits.set(stamp);
                stamps.insert(stamp);
            }
            expect_equal(bits, stamps, stamp);
            expect_equal(bits, stamps, some_stamp(capacity));
        }
        const StampBits::Ranks ranks(bits);
        for (int i = 0; i < 20; ++i) {
            const std::uint32_t stamp = some_stamp(capacity);
            expect_equal(bits, stamps, stamp);
            RC_ASSERT(ranks.below(stamp) == below(stamps, stamp));
        }
        bits.reset();
        expect_equal(bits, {}, some_stamp(capacity));
    }));
}

TEST(StampBits, WhenAllAreSetAsManyLieAboveAsFollow) {
    // The greatest counts there are: 64 a word, 2048 a group, 65,536 a block.
    StampBits bits(2 * block);
    bits.set_range(0, 2 * block);
    const StampBits::Ranks ranks(bits);
    for (std::uint32_t stamp = 0; stamp < 2 * block; stamp += stamp % group < 66 ? 1 : 61) {
        ASSERT_EQ(bits.above(stamp, 2 * block - 1), 2 * block - 1 - stamp);
        ASSERT_EQ(ranks.below(stamp), stamp);
    }
    EXPECT_EQ(bits.count(), 2 * block);
    for (std::uint32_t stamp = 0; stamp < 2 * block; ++stamp) bits.clear(stamp);
    EXPECT_EQ(bits.count(), 0u);
    EXPECT_EQ(bits.above(0, 2 * block - 1), 0u);
}

TEST(StampBits, TheFirstAndTheLast) {
    StampBits bits(2 * block);
    bits.set(0);
    bits.set(2 * block - 1);
    EXPECT_EQ(bits.above(0, 2 * block - 1), 1u);
    EXPECT_EQ(bits.above(1, 2 * block - 1), 1u);
    EXPECT_EQ(bits.above(2 * block - 2, 2 * block - 1), 1u);
    EXPECT_EQ(bits.above(2 * block - 1, 2 * block - 1), 0u);
    EXPECT_EQ(StampBits::Ranks(bits).below(0), 0u);
    EXPECT_EQ(StampBits::Ranks(bits).below(2 * block - 1), 1u);
}

TEST(StampBits, CapacitiesAreRoundedUpToPowersOfTwo) {
    EXPECT_EQ(StampBits(0).capacity(), block);
    EXPECT_EQ(StampBits(block).capacity(), block);
    EXPECT_EQ(StampBits(block + 1).capacity(), 2 * block);
    EXPECT_EQ(StampBits(~std::uint64_t{0}).capacity(), std::uint64_t{1} << 28);
}

}  // namespace
}  // namespace regather::cachesim
