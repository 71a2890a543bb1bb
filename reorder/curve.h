// reorder/curve.h -- the codes of spatial/curve.h for query positions, one more by table, and what each
// costs.
#pragma once
#include <cstdint>

#include "reorder/cell.h"
#include "spatial/curve.h"

namespace regather::reorder {

using spatial::hilbert_code;
using spatial::max_curve_bits;
using spatial::morton_code;
using spatial::spread_bits;

/// As morton_code, by table; coordinates below 2^8.
std::uint32_t swizzle_code(const Cell& cell);

/// Operations a code costs beside finding the cell; counted from the code in curve.cpp.
std::uint64_t morton_ops();
std::uint64_t hilbert_ops(std::uint32_t bits);
std::uint64_t swizzle_ops();

}  // namespace regather::reorder
