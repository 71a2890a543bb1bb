// spatial/walk_bits.h -- reading the bits of a walk (spatial/walk.h) many at a time.
#pragma once
#include <cstdint>
#include <cstring>

namespace regather::spatial {

/// Bits that bits_at() gives at least.
constexpr int whole_bits = 57;
/// Bytes that it may read past the last bit asked for.
constexpr std::size_t walk_padding = 24;

/// The bits from `position` on, at the top of the word; the lowest seven are not to be relied on.
inline std::uint64_t bits_at(const std::uint8_t* bytes, std::uint64_t position) {
    std::uint64_t word;
    std::memcpy(&word, bytes + position / 8, 8);
    return __builtin_bswap64(word) << (position % 8);
}

/// The front of a walk, some bits at a time, at the top of a word. `bytes` has walk_padding behind its end.
struct WalkBits {
    explicit WalkBits(const std::uint8_t* from) : bytes(from), word(bits_at(from, 0)) {}

    void refill() {
        word = bits_at(bytes, position);
        left = whole_bits;
    }
    /// What has been shifted out of the word.
    void count(unsigned bits) {
        position += bits;
        left -= bits;
    }
    void take(unsigned bits) {
        word <<= bits;
        count(bits);
    }

    const std::uint8_t* bytes;
    std::uint64_t position = 0;  ///< Of the word's first bit.
    std::uint64_t word;
    unsigned left = whole_bits;  ///< Bits of the word to be relied on; the others are not to be read.
};

}  // namespace regather::spatial
