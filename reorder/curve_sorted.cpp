#include "reorder/curve_sorted.h"

#include <tbb/parallel_for.h>

#include <bit>

#include "reorder/cell.h"
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
    require_range(name_of(config.curve), "bits", config.bits, 1,
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

    const auto assign = [&](auto code_of) {
        tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) {
            const Vec3 position = work.position[i];
            const std::uint64_t code = is_finite(position) ? code_of(grid.cell_of(position)) : beyond;
            const std::uint64_t tile = tiling.tile_of(work.pixel[i]);
            keys[i] = tile << (3 * bits) << 1 | code;
        });
    };
    std::uint64_t ops = CellGrid::ops;
    switch (config_.curve) {
        case Curve::hilbert:
            assign([bits](const Cell& cell) { return hilbert_code(morton_code(cell), bits); });
            ops += hilbert_ops(bits);
            break;
        case Curve::morton:
            assign([](const Cell& cell) { return morton_code(cell); });
            ops += morton_ops();
            break;
        case Curve::swizzle:
            assign([](const Cell& cell) { return std::uint64_t{swizzle_code(cell)}; });
            ops += swizzle_ops();
            break;
    }
    return deferred_cost(work, tiling, {.ops_per_key = ops, .key_bits = 3 * bits}, onchip_bytes);
}

}  // namespace regather::reorder
