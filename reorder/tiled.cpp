#include "reorder/tiled.h"

#include <tbb/parallel_for.h>

#include "reorder/tiling.h"

namespace regather::reorder {

Tiled::Tiled(const TiledConfig& config) : config_(config) {
    require_tile("tiled", config.tile);
}

Cost Tiled::assign_keys(const Workload& work, std::uint64_t, std::span<std::uint64_t> keys) const {
    const Tiling tiling(work, config_.tile);
    const std::uint64_t edge = config_.tile;
    tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) {
        const std::uint64_t row = tiling.row_in_tile(work.pixel[i]);
        std::uint64_t column = tiling.column_in_tile(work.pixel[i]);
        if (config_.rows == Rows::alternating && row % 2 == 1) column = edge - 1 - column;
        keys[i] = (tiling.tile_of(work.pixel[i]) * edge + row) * edge + column;
    });
    return {};
}

}  // namespace regather::reorder
