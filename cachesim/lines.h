// cachesim/lines.h -- bytes to cache lines: an access touches every line that one of its bytes lies on.
#pragma once
#include <bit>
#include <cstdint>
#include <vector>

#include "cachesim/cache.h"

namespace regather::cachesim {

/// The bytes [address, address + bytes). The last byte's address fits into 64 bits.
struct ByteAccess {
    std::uint64_t address = 0;
    std::uint64_t bytes = 1;
    Access kind = Access::read;
    friend bool operator==(const ByteAccess&, const ByteAccess&) = default;
};

/// Calls touch(Line) for every line of [address, address + bytes), in ascending order; none for 0 bytes.
/// line_bytes is a power of two.
template <class Touch>
void for_each_line(std::uint64_t address, std::uint64_t bytes, std::uint32_t line_bytes, Touch&& touch) {
    if (bytes == 0) return;
    const int shift = std::countr_zero(line_bytes);
    std::uint64_t line = address >> shift;
    const std::uint64_t last = (address + (bytes - 1)) >> shift;
    for (touch(Line{line}); line != last; touch(Line{line})) ++line;
}

inline void append_lines(std::vector<Line>& lines, std::uint64_t address, std::uint64_t bytes,
                         std::uint32_t line_bytes) {
    for_each_line(address, bytes, line_bytes, [&](Line line) { lines.push_back(line); });
}

}  // namespace regather::cachesim
