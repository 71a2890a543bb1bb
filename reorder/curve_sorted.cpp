#include "reorder/curve_sorted.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

#include "reorder/cell.h"
#include "reorder/cell_block.h"
#include "reorder/curve.h"
#include "reorder/deferred.h"
#include "reorder/tiling.h"

namespace regather::reorder {
namespace {

std::string_view name_of(Curve curve) {
    switch (curve) {
        case Curve::hilbert:
            return "hilbert";
        case Curve::morton:
            return "morton";
        default:
            return "swizzle";
    }
}

}  // namespace

CurveSorted::CurveSorted(const CurveSortedConfig& config) : config_(config) {
    require_tile(name_of(config.curve), config.tile);
    trace::require_range(name_of(config.curve), "bits", config.bits, 1,
                         config.curve == Curve::swizzle ? max_swizzle_bits : max_curve_bits);
}

Cost CurveSorted::assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                              std::span<std::uint64_t> keys) const {
    const Tiling tiling(work, config_.tile);
    // One bit above the code marks positions that have no cell.
    const auto tile_bits = static_cast<std::uint32_t>(std::bit_width(tiling.tiles() - 1));
    const std::uint32_t bits = std::min(config_.bits, (63 - tile_bits) / 3);
    const std::uint64_t beyond = std::uint64_t{1} << 3 * bits;
    const CellGrid grid(work.bounds, 1u << bits);

    // Codes of a block at a time, so that their loops are vectors; `turn` prepares the cells for `code_of`.
    const bool tiled = tiling.tiles() > 1;
    const std::size_t blocks = (keys.size() + CellBlock::cells - 1) / CellBlock::cells;
    const auto assign = [&](auto turn, auto code_of) {
        tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t number) {
            const std::size_t begin = number * CellBlock::cells;
            const std::size_t count = std::min(CellBlock::cells, keys.size() - begin);
            const float* const at = &work.position[begin].x;  // three floats a position
            std::uint64_t* const key = keys.data() + begin;
            CellBlock block;
            for (std::size_t i = 0; i < count; ++i) block.x[i] = grid.along(at[3 * i], 0);
            for (std::size_t i = 0; i < count; ++i) block.y[i] = grid.along(at[3 * i + 1], 1);
            for (std::size_t i = 0; i < count; ++i) block.z[i] = grid.along(at[3 * i + 2], 2);
            turn(block);
            for (std::size_t i = 0; i < count; ++i) key[i] = code_of(block.x[i], block.y[i], block.z[i]);
            for (std::size_t i = 0; i < count; ++i)
                if (!is_finite(work.position[begin + i])) key[i] = beyond;
            if (!tiled) return;
            std::uint32_t pixel = work.pixel[begin];  // samples of a pixel are neighbours
            std::uint64_t tile = tiling.tile_of(pixel);
            for (std::size_t i = 0; i < count; ++i) {
                if (work.pixel[begin + i] != pixel) {
                    pixel = work.pixel[begin + i];
                    tile = tiling.tile_of(pixel);
                }
                key[i] |= tile << (3 * bits) << 1;
            }
        });
    };
    const auto as_it_is = [](CellBlock&) {};
    const auto morton = [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return spread_bits(x) << 2 | spread_bits(y) << 1 | spread_bits(z);
    };
    std::uint64_t ops = CellGrid::ops;
    switch (config_.curve) {
        case Curve::hilbert:
            assign([bits](CellBlock& block) { turn_along_hilbert(block, bits); }, morton);
            ops += hilbert_ops(bits);
            break;
        case Curve::morton:
            assign(as_it_is, morton);
            ops += morton_ops();
            break;
        case Curve::swizzle:
            assign(as_it_is, [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
                return std::uint64_t{swizzle_code({x, y, z})};
            });
            ops += swizzle_ops();
            break;
    }
    return deferred_cost(work, tiling, {.ops_per_key = ops, .key_bits = 3 * bits}, onchip_bytes);
}

BufferUse CurveSorted::buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                                  std::span<const std::uint32_t> permutation) const {
    return deferred_buffer_use(work, Tiling(work, config_.tile), onchip_bytes, permutation);
}

}  // namespace regather::reorder
