// reorder/cell_block.h -- many cells at once, as lanes of vector registers want them.
#pragma once
#include <cstddef>
#include <cstdint>

namespace regather::reorder {

struct CellBlock {
    static constexpr std::size_t cells = 256;
    alignas(64) std::uint32_t x[cells]{}, y[cells]{}, z[cells]{};
};

/// Turns each cell into the one whose Morton code is the cell's Hilbert code: morton_code(turned) ==
/// hilbert_code(morton_code(cell), bits). Coordinates below 2^bits; bits 1 to 21. The same on any vector
/// width.
void turn_along_hilbert(CellBlock& block, std::uint32_t bits);

}  // namespace regather::reorder
