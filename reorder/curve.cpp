#include "reorder/curve.h"

namespace regather::reorder {
namespace {

struct SpreadTable {
    std::uint32_t of[256];
    SpreadTable() {
        for (std::uint32_t x = 0; x < 256; ++x) of[x] = static_cast<std::uint32_t>(spread_bits(x));
    }
};
const SpreadTable spread_byte;

}  // namespace

std::uint64_t morton_ops() {
    return 3 * 15 + 4;
}

// A step: shift and mask the octants, shift and join the state, look up, shift the code, mask and join the
// place, shift out the state.
std::uint64_t hilbert_ops(std::uint32_t bits) {
    return morton_ops() + 9 * (bits / 3 + bits % 3);
}

std::uint32_t swizzle_code(const Cell& cell) {
    return spread_byte.of[cell[0]] << 2 | spread_byte.of[cell[1]] << 1 | spread_byte.of[cell[2]];
}

std::uint64_t swizzle_ops() {
    return 3 + 4;
}

}  // namespace regather::reorder
