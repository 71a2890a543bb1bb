// reorder/strata.h -- several passes over a tile, each making one stratum of every pixel's hemisphere of
// gather directions. The generative order of the paper, section 6.3.1, as a machine would do it whose
// directions are stratified: a pass knows its stratum, so no direction is drawn and thrown away.
#pragma once
#include <vector>

#include "reorder/ordering.h"
#include "reorder/tile_passes.h"

namespace regather::reorder {

/// In which sequence the strata of the grid are made.
enum class StrataOrder : std::uint8_t { rows, columns, morton };

/// local: strata of the unit square that the samples are drawn from, so each pixel's in the frame of its own
/// surface. world: bins of directions, as those of DirectionBinned; the first pass draws each direction once
/// and keeps a list of them by bin for each pixel.
enum class StrataFrame : std::uint8_t { local, world };

struct StrataConfig {
    std::uint32_t tile = 16;    ///< Edge [pixels].
    std::uint32_t strata = 10;  ///< strata x strata passes. Coarser than the capture's: a pass makes several.
    StrataOrder order = StrataOrder::rows;
    StrataFrame frame = StrataFrame::local;
    PixelState state = PixelState::store;  ///< In the frame of the world: store.
};

inline constexpr std::uint32_t max_strata = 1024;

/// Tile by tile, stratum by stratum; inside a pass in capture order.
class Strata final : public Ordering {
public:
    explicit Strata(const StrataConfig& config);  ///< trace::UsageError names the field at fault.
    Reads reads() const override;
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<std::uint64_t> keys) const override;
    BufferUse buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                         std::span<const std::uint32_t> permutation) const override;

private:
    TilePasses tile_passes(const Workload& work) const;
    void assign_passes(const Workload& work, std::span<std::uint64_t> pass) const;

    StrataConfig config_;
    std::vector<std::uint32_t> rank_;  // of a stratum, row x strata + column: its pass
};

}  // namespace regather::reorder
