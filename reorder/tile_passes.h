// reorder/tile_passes.h -- several passes over each tile, and the state of its pixels that the later ones
// need. The paper, section 6.3.1.
#pragma once
#include <cstdint>
#include <span>

#include "reorder/ordering.h"

namespace regather::reorder {

/// What later passes need of a pixel's eye ray is kept from the first pass, or cast again.
enum class PixelState : std::uint8_t { store, recast };

struct TilePasses {
    std::uint32_t tile = 1;    ///< Edge [pixels].
    std::uint64_t passes = 1;  ///< Over a tile.
    PixelState state = PixelState::store;
    std::uint64_t state_bytes = pixel_state_bytes;  ///< Of a pixel, where it is stored.
};

/// buffered_bytes, reorder_bytes and recast_rays. A stored state is written by the first pass and read by
/// each of the others; one pass stores nothing.
Cost cost_of(const TilePasses& passes, const Workload& work, std::uint64_t onchip_bytes);

/// What a stored state does in memory when the chip cannot hold it; else nothing. `pass`: of each query,
/// counted over all tiles, tile x passes + pass; it ascends along the permutation.
BufferUse buffer_use_of(const TilePasses& passes, const Workload& work, std::uint64_t onchip_bytes,
                        std::span<const std::uint32_t> permutation, std::span<const std::uint64_t> pass);

}  // namespace regather::reorder
