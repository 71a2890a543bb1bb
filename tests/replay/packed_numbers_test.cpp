// Numbers in as few bits as the greatest needs: bytes written down by hand, and every width there and back.
#include "replay/packed_numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace regather::replay {
namespace {

using testing::ElementsAre;

std::vector<std::uint8_t> packed(const std::vector<std::uint32_t>& numbers, unsigned width) {
    std::vector<std::uint8_t> bytes;
    pack(numbers, width, bytes);
    return bytes;
}

TEST(PackedNumbers, WidthsAreThoseThatTheGreatestNeeds) {
    EXPECT_EQ(packed_width(0), 0u);
    EXPECT_EQ(packed_width(1), 1u);
    EXPECT_EQ(packed_width(255), 8u);
    EXPECT_EQ(packed_width(256), 9u);
    EXPECT_EQ(packed_width(~0u), 32u);
    EXPECT_EQ(packed_bytes(3, 3), 2u);
    EXPECT_EQ(packed_bytes(8, 5), 5u);
    EXPECT_EQ(packed_bytes(1000, 0), 0u);
}

TEST(PackedNumbers, BytesAreThoseWrittenByHand) {
    // 5, 2, 7 in three bits each, the lowest first: 101 | 010 << 3 | 111 << 6 = 1 1101 0101.
    EXPECT_THAT(packed({5, 2, 7}, 3), ElementsAre(0xd5, 0x01));
    EXPECT_THAT(packed({0x12345678, 0x9abcdef0}, 32),
                ElementsAre(0x78, 0x56, 0x34, 0x12, 0xf0, 0xde, 0xbc, 0x9a));
    EXPECT_THAT(packed({0, 0, 0}, 0), ElementsAre());
    EXPECT_THAT(packed({}, 17), ElementsAre());
}

TEST(PackedNumbers, ComeBackWhateverTheirWidthAndNumber) {
    for (unsigned width = 0; width <= 32; ++width)
        ASSERT_TRUE(rc::check("lists one behind the other", [width] {
            const std::uint64_t end = std::uint64_t{1} << width;
            std::vector<std::vector<std::uint32_t>> lists(2);
            std::vector<std::uint8_t> bytes{0xa5};
            std::vector<std::size_t> starts;
            for (std::vector<std::uint32_t>& list : lists) {
                list.resize(*rc::gen::inRange<std::size_t>(0, 60));
                for (std::uint32_t& number : list)
                    number = static_cast<std::uint32_t>(*rc::gen::inRange<std::uint64_t>(0, end));
                if (!list.empty()) list.back() = static_cast<std::uint32_t>(end - 1);
                starts.push_back(bytes.size());
                pack(list, width, bytes);
                RC_ASSERT(bytes.size() == starts.back() + packed_bytes(list.size(), width));
            }
            RC_ASSERT(bytes[0] == 0xa5);
            bytes.insert(bytes.end(), packed_padding, 0xff);
            for (std::size_t l = 0; l < lists.size(); ++l) {
                std::vector<std::uint32_t> found(lists[l].size() + unpacked_padding);
                unpack(bytes.data() + starts[l], width, lists[l].size(), found.data());
                found.resize(lists[l].size());
                RC_ASSERT(found == lists[l]);
            }
        })) << width;
}

}  // namespace
}  // namespace regather::replay
