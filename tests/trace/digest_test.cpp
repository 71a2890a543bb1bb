#include "trace/digest.h"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <numeric>
#include <vector>

namespace regather::trace {
namespace {

// xxHash's own sanity checks: XXH3-64 of no bytes with seed 0.
TEST(Digest, OfNoBytesIsXxhashsOwn) {
    EXPECT_EQ(digest_of(""), "2d06800538d394c2");
    EXPECT_EQ(Digest().hexadecimal(), "2d06800538d394c2");
    EXPECT_EQ(Digest().value(), 0x2d06800538d394c2u);
}

TEST(Digest, InHexadecimalHasSixteenDigitsTheHighestFirst) {
    EXPECT_EQ(hexadecimal(0x0123'4567'89ab'cdef), "0123456789abcdef");
    EXPECT_EQ(hexadecimal(10), "000000000000000a");
}

// Lengths on both sides of where XXH3 changes its method, 240 bytes, and of its buffer of 256.
TEST(Digest, PieceByPieceItIsThatOfTheWholeForAnySeed) {
    for (const std::size_t count : {1u, 60u, 61u, 64u, 65u, 500u}) {
        std::vector<std::uint32_t> values(count);
        std::iota(values.begin(), values.end(), 7u);
        for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1}, ~std::uint64_t{0} / 3}) {
            Digest one_by_one(seed), at_once(seed);
            for (const std::uint32_t value : values) one_by_one.add(value);
            at_once.add_all(std::span<const std::uint32_t>(values));
            EXPECT_EQ(one_by_one.value(), XXH3_64bits_withSeed(values.data(), 4 * count, seed)) << count;
            EXPECT_EQ(at_once.value(), one_by_one.value());
        }
    }
}

}  // namespace
}  // namespace regather::trace
