#include "reorder/tile_passes.h"

#include "reorder/tiling.h"

namespace regather::reorder {

Cost cost_of(const TilePasses& passes, const Workload& work, std::uint64_t onchip_bytes) {
    Cost cost;
    const std::uint64_t pixels = std::uint64_t{work.image_width} * work.image_height;
    if (passes.state == PixelState::recast) {
        cost.recast_rays = pixels * (passes.passes - 1);
    } else if (passes.passes > 1) {
        cost.buffered_bytes = Tiling(work, passes.tile).pixels_in_tile() * passes.state_bytes;
        if (cost.buffered_bytes > onchip_bytes)
            cost.reorder_bytes = pixels * passes.state_bytes * passes.passes;
    }
    return cost;
}

BufferUse buffer_use_of(const TilePasses& passes, const Workload& work, std::uint64_t onchip_bytes,
                        std::span<const std::uint32_t> permutation, std::span<const std::uint64_t> pass) {
    if (cost_of(passes, work, onchip_bytes).reorder_bytes == 0) return {};
    PixelPasses state;
    state.state_bytes = passes.state_bytes;
    state.image_width = work.image_width;
    state.image_height = work.image_height;
    state.tile = passes.tile;
    state.passes = static_cast<std::uint32_t>(passes.passes);
    state.pixel = work.pixel;
    for (std::size_t r = 0; r < permutation.size(); ++r) {
        const std::uint64_t own = pass[permutation[r]];
        if (state.runs.empty() || state.runs.back().pass != own) state.runs.push_back({own, r});
        state.runs.back().end = r + 1;
    }
    BufferUse use;
    use.state = std::move(state);
    return use;
}

}  // namespace regather::reorder
