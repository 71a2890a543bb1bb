#include "reorder/leaf_sorted.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

#include "reorder/deferred.h"
#include "reorder/tiling.h"

namespace regather::reorder {

LeafSorted::LeafSorted(const LeafSortedConfig& config) : config_(config) {
    require_tile(config.column == LeafColumn::kd ? "kd-leaf" : "bvh-leaf", config.tile);
}

Reads LeafSorted::reads() const {
    return {.leaf_kd = config_.column == LeafColumn::kd, .leaf_bvh = config_.column == LeafColumn::bvh};
}

Cost LeafSorted::assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                             std::span<std::uint64_t> keys) const {
    const Tiling tiling(work, config_.tile);
    const std::span<const std::uint32_t> label =
        config_.column == LeafColumn::kd ? work.leaf_kd : work.leaf_bvh;
    tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) {
        keys[i] = std::uint64_t{tiling.tile_of(work.pixel[i])} << 32 | label[i];
    });
    const std::uint32_t greatest = label.empty() ? 0 : *std::max_element(label.begin(), label.end());
    return deferred_cost(work, tiling, {.key_bits = static_cast<std::uint32_t>(std::bit_width(greatest))},
                         onchip_bytes);
}

BufferUse LeafSorted::buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                                 std::span<const std::uint32_t> permutation) const {
    return deferred_buffer_use(work, Tiling(work, config_.tile), onchip_bytes, permutation);
}

}  // namespace regather::reorder
