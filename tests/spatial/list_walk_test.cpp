// Walks as lists of elements: bytes drawn by hand, round trips, damage.
#include "spatial/list_walk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <vector>

namespace regather::spatial {
namespace {

using testing::ElementsAre;

std::vector<std::uint8_t> walk_of(const std::vector<std::uint32_t>& elements) {
    ListWalkRecorder recorder;
    for (const std::uint32_t element : elements) recorder.visit(element);
    const std::uint32_t bytes = recorder.finish();
    EXPECT_EQ(bytes, recorder.bytes().size());
    EXPECT_EQ(recorder.visited_nodes(), elements.size());
    return {recorder.bytes().begin(), recorder.bytes().end()};
}

std::vector<std::uint32_t> list(std::span<const std::uint32_t> elements) {
    return {elements.begin(), elements.end()};
}

/// Elements that are near each other, anywhere, or one behind the other.
rc::Gen<std::vector<std::uint32_t>> any_visits() {
    return rc::gen::exec([] {
        std::vector<std::uint32_t> visits;
        std::uint32_t at = *rc::gen::element(0u, 1000u, 0x80000000u, 0xfffffff0u);
        for (int left = *rc::gen::inRange(0, 200); left > 0; --left) {
            switch (*rc::gen::inRange(0, 5)) {
                case 0:
                    at += 1;
                    break;
                case 1:
                    at += static_cast<std::uint32_t>(*rc::gen::inRange(-128, 129));
                    break;
                case 2:
                    at += static_cast<std::uint32_t>(*rc::gen::inRange(-32769, 32770));
                    break;
                case 3:
                    at = *rc::gen::arbitrary<std::uint32_t>();
                    break;
                default:
                    break;  // again
            }
            visits.push_back(at);
        }
        return visits;
    });
}

TEST(ListWalk, TheBytesAreThoseDrawnByHand) {
    // Steps 0, 0, 3 and -3 from one behind: values 0, 0, 6 and 5; codes 0, 0, 1, 1 from the lowest bits up.
    EXPECT_THAT(walk_of({0, 1, 5, 3}), ElementsAre(4, 0b01'01'00'00, 6, 5));
    // 300 from 2^32 - 1: 600 in two bytes; then 70,000 + 1 behind it: 140,000 in four; the last two are
    // missing.
    EXPECT_THAT(walk_of({300, 70'301}), ElementsAre(2, 0b11'10, 0x58, 0x02, 0xe0, 0x22, 0x02, 0x00));
    // 130 visits in a row: a number of two bytes, 33 groups without values.
    std::vector<std::uint32_t> row(130);
    for (std::uint32_t i = 0; i < 130; ++i) row[i] = i;
    const std::vector<std::uint8_t> walk = walk_of(row);
    EXPECT_EQ(walk.size(), 2u + 33u);
    EXPECT_EQ(walk[0], 0x82);
    EXPECT_EQ(walk[1], 1);
    EXPECT_TRUE(walk_of({}).empty());
}

TEST(ListWalk, DecodingGivesTheVisits) {
    ASSERT_TRUE(rc::check([] {
        const auto visits = *any_visits();
        ListWalkDecoder decoder(~0u);
        const std::vector<std::uint8_t> walk = walk_of(visits);
        const auto [fault, elements] = decoder.decode(walk);
        const bool last = std::find(visits.begin(), visits.end(), ~0u) != visits.end();
        RC_ASSERT(fault == (last ? WalkFault::enters_missing_child : WalkFault::none));
        if (last) return;
        RC_ASSERT(list(elements) == visits);
        RC_ASSERT(decoder.walk_bytes() == walk.size());
    }));
}

TEST(ListWalk, ManyWalksShareOneBufferAndBitsFollowThem) {
    ASSERT_TRUE(rc::check([] {
        ListWalkRecorder recorder;
        ListWalkDecoder decoder(~0u);
        std::vector<std::vector<std::uint32_t>> all;
        std::vector<std::uint32_t> list_bytes, bit_bytes;
        const auto bits = *rc::gen::inRange(0, 20);
        for (int walks = *rc::gen::inRange(1, 5); walks > 0; --walks) {
            all.push_back(*any_visits());
            std::erase(all.back(), ~0u);
            all.back().push_back(7);  // no bits without a list
            for (const std::uint32_t element : all.back()) recorder.visit(element);
            list_bytes.push_back(recorder.finish());
            for (int b = 0; b < bits; ++b) recorder.push(b % 3 == 0);
            bit_bytes.push_back(recorder.finish());
            RC_ASSERT(bit_bytes.back() == static_cast<std::uint32_t>((bits + 7) / 8));
        }
        std::size_t start = 0;
        for (std::size_t w = 0; w < all.size(); ++w) {
            const auto walk = recorder.bytes().subspan(start, list_bytes[w] + bit_bytes[w]);
            const auto [fault, elements] = decoder.decode(walk);
            RC_ASSERT(list(elements) == all[w]);
            RC_ASSERT(fault == (bit_bytes[w] > 0 ? WalkFault::bytes_left_over : WalkFault::none));
            RC_ASSERT(decoder.walk_bytes() == list_bytes[w]);
            for (int b = 0; b < bits; ++b)
                RC_ASSERT((walk[list_bytes[w] + static_cast<std::size_t>(b) / 8] >> (7 - b % 8) & 1) ==
                          (b % 3 == 0 ? 1 : 0));
            start += walk.size();
        }
        RC_ASSERT(start == recorder.bytes().size());
    }));
}

TEST(ListWalk, DamagedWalksAreToldApart) {
    std::vector<std::uint32_t> visits;
    for (std::uint32_t i = 0; i < 50; ++i) visits.push_back(i * 7919 % 1000);
    std::vector<std::uint8_t> walk = walk_of(visits);
    ListWalkDecoder decoder(1000);
    EXPECT_EQ(decoder.decode(walk).fault, WalkFault::none);
    for (std::size_t bytes = 1; bytes < walk.size(); ++bytes)
        EXPECT_EQ(decoder.decode(std::span(walk).first(bytes)).fault, WalkFault::ends_early) << bytes;
    walk.push_back(0);
    EXPECT_EQ(decoder.decode(walk).fault, WalkFault::bytes_left_over);
    // Elements that there are not, among the first and among the last.
    for (const std::size_t wrong : {std::size_t{3}, std::size_t{49}}) {
        std::vector<std::uint32_t> beyond = visits;
        beyond[wrong] = 1000;
        const auto [fault, elements] = decoder.decode(walk_of(beyond));
        EXPECT_EQ(fault, WalkFault::enters_missing_child);
        EXPECT_EQ(elements.size(), wrong);
    }
    EXPECT_EQ(ListWalkDecoder(0).decode(walk_of({0})).fault, WalkFault::enters_missing_child);
    // No visits in a byte; a number that goes on for ever; a code for a fourth visit of three.
    EXPECT_EQ(decoder.decode(std::vector<std::uint8_t>{0}).fault, WalkFault::bytes_left_over);
    EXPECT_EQ(decoder.decode(std::vector<std::uint8_t>(30, 0xff)).fault, WalkFault::ends_early);
    EXPECT_EQ(decoder.decode(std::vector<std::uint8_t>{3, 0b01'00'00'00, 0}).fault, WalkFault::ends_early);
}

TEST(ListWalk, ArbitraryBytesNeverLeaveTheStructure) {
    ASSERT_TRUE(rc::check([] {
        const auto count = *rc::gen::element(0u, 1u, 5u, 300u, 1u << 20);
        const auto bytes = *rc::gen::arbitrary<std::vector<std::uint8_t>>();
        ListWalkDecoder decoder(count);
        for (const std::uint32_t element : decoder.decode(bytes).elements) RC_ASSERT(element < count);
    }));
}

}  // namespace
}  // namespace regather::spatial
