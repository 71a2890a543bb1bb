// spatial/curve.h -- codes of cells along space-filling curves over a cube of 2^bits cells an edge.
// Morton: bits interleaved, x highest. Hilbert: the states (entry corner, direction) of Hamilton, "Compact
// Hilbert Indices", 2006, as a table that takes three levels at once.
#pragma once
#include <cstdint>

#include "spatial/cell.h"

namespace regather::spatial {

inline constexpr std::uint32_t max_curve_bits = 21;  ///< An axis; a code then has 63 bits.

/// Two zero bits between each two bits: five steps of shift, or, and. Of the lower 21.
constexpr std::uint64_t spread_bits(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    x = (x | x << 2) & 0x1249249249249249;
    return x;
}

/// Bit 3 i + 2 is bit i of x, 3 i + 1 of y, 3 i of z. Coordinates below 2^21.
constexpr std::uint64_t morton_code(const Cell& cell) {
    return spread_bits(cell[0]) << 2 | spread_bits(cell[1]) << 1 | spread_bits(cell[2]);
}

/// Position on the Hilbert curve of the cell with this Morton code; coordinates below 2^bits. Consecutive
/// codes are cells that share a face; the code of a cell's parent cube at bits - 1 is code >> 3. For one
/// cell; for many: reorder/cell_block.h.
std::uint64_t hilbert_code(std::uint64_t morton, std::uint32_t bits);

}  // namespace regather::spatial
