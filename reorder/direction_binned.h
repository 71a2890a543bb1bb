// reorder/direction_binned.h -- several passes over a tile, each making only the gather rays of an interval
// of directions. The paper, section 6.3.1, "Tiled direction-binning reordering".
#pragma once
#include "reorder/ordering.h"
#include "reorder/tile_passes.h"

namespace regather::reorder {

struct DirectionBinnedConfig {
    std::uint32_t tile = 16;   ///< Edge [pixels].
    std::uint32_t bins = 16;   ///< bins x bins bins of equal solid angle.
    std::uint32_t passes = 0;  ///< Over a tile; each covers a run of bins. 0: one pass a bin.
    PixelState state = PixelState::store;
};

inline constexpr std::uint32_t max_bins = 4096;

/// In [0, bins^2): row floor((z + 1) / 2 bins) by cos theta from -z up, in it column floor(phi / 2 pi bins)
/// from +x towards +y. Bins have equal solid angles. A direction of no or no finite length is in the last
/// bin.
std::uint32_t direction_bin(Vec3 direction, std::uint32_t bins);

/// Tile by tile, pass by pass; inside a pass in capture order.
class DirectionBinned final : public Ordering {
public:
    explicit DirectionBinned(
        const DirectionBinnedConfig& config);  ///< trace::UsageError names the field at fault.
    Reads reads() const override { return {.direction = true}; }
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<std::uint64_t> keys) const override;
    BufferUse buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                         std::span<const std::uint32_t> permutation) const override;

private:
    TilePasses tile_passes() const;
    /// By query, counted over all tiles.
    void assign_passes(const Workload& work, std::span<std::uint64_t> pass) const;

    DirectionBinnedConfig config_;
};

}  // namespace regather::reorder
