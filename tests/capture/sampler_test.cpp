#include "capture/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <utility>
#include <vector>

namespace regather::capture {
namespace {

using Block = std::array<std::uint32_t, 4>;

Block block_of(Sampler& sampler) {
    Block block{};
    for (std::uint32_t& word : block) word = sampler.bits();
    return block;
}

Block philox(const Block& counter, const std::array<std::uint32_t, 2>& key) {
    const auto block =
        r123::Philox4x32()({{counter[0], counter[1], counter[2], counter[3]}}, {{key[0], key[1]}});
    return {block[0], block[1], block[2], block[3]};
}

// Random123, tests/kat_vectors, the lines "philox4x32 10".
TEST(Sampler, PhiloxGivesItsPublishedValues) {
    EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
              (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
    Sampler first(0, Stream::photon, 0);
    EXPECT_EQ(block_of(first), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
}

TEST(Sampler, TheSeedIsTheKeyAndAllElseTheCounter) {
    Sampler sampler(0x0123456789abcdef, Stream::shadow, 0x000000aabbccddee, 77);
    const std::array<std::uint32_t, 2> key{0x89abcdef, 0x01234567};
    for (std::uint32_t four = 0; four < 3; ++four)
        EXPECT_EQ(block_of(sampler), philox({four, 77, 0xbbccddee, 0xaa << 8 | 2}, key)) << four;
}

// Philox is a bijection of its counter: blocks of one seed are equal only when their counters are.
TEST(Sampler, StreamsIndicesSamplesAndDimensionsShareNoNumbers) {
    std::set<Block> all;
    std::size_t count = 0;
    for (const Stream stream : {Stream::photon, Stream::eye, Stream::shadow, Stream::gather,
                                Stream::caustic_photon, Stream::reference})
        for (const std::uint64_t index :
             {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{64}, std::uint64_t{1} << 32,
              (std::uint64_t{1} << 32) + 1, std::uint64_t{1} << 40, (std::uint64_t{1} << 56) - 1})
            for (const std::uint32_t sample : {0u, 1u, 2u, 0xffffffffu}) {
                Sampler sampler(5, stream, index, sample);
                for (int four = 0; four < 5; ++four, ++count) all.insert(block_of(sampler));
            }
    EXPECT_EQ(all.size(), count);
    EXPECT_EQ(count, 6u * 8 * 4 * 5);
}

// With the first word 0x6627e8d5 and the second 0xe169c58d.
TEST(Sampler, FractionsAreTheLeadingBits) {
    EXPECT_EQ(Sampler(0, Stream::photon, 0).uniform(), 0x6627e8p-24f);
    EXPECT_EQ(Sampler(0, Stream::photon, 0).fine_uniform(), 0x6627e8d5e169c58dp-64 - 0x58dp-64);
    EXPECT_EQ(Sampler(0, Stream::photon, 0).below(10), 3u);  // 0.399 of 10
    EXPECT_EQ(Sampler(0, Stream::photon, 0).below(1), 0u);
}

}  // namespace
}  // namespace regather::capture
