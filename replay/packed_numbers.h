// replay/packed_numbers.h -- whole numbers in as many bits each as the greatest of them needs, one behind the
// other, the lowest bit first. Eight at a time are brought into place by a shuffle of bytes and a shift
// (Lemire & Boytsov, "Decoding billions of integers per second through vectorization", 2015, section 4).
#pragma once
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace regather::replay {

/// The bits that numbers up to `greatest` need: 0 to 32.
inline unsigned packed_width(std::uint32_t greatest) {
    return static_cast<unsigned>(std::bit_width(greatest));
}
/// What `count` numbers take [bytes].
inline std::uint64_t packed_bytes(std::uint64_t count, unsigned width) {
    return (count * width + 7) / 8;
}
/// Bytes that unpack() may read past the last number.
inline constexpr std::size_t packed_padding = 32;
/// Numbers that unpack() may write past the last one.
inline constexpr std::size_t unpacked_padding = 8;

/// Appends packed_bytes(). No number needs more than `width` bits.
void pack(std::span<const std::uint32_t> numbers, unsigned width, std::vector<std::uint8_t>& to);

/// Gives `count` numbers back.
void unpack(const std::uint8_t* from, unsigned width, std::size_t count, std::uint32_t* to);

}  // namespace regather::replay
