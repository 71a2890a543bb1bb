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

}  // namespace regather::spatial
