// reorder/curve_sorted.h -- queries sorted by the code of their position along a curve, all at once or tile
// by tile. The paper, section 6.3.2: "Hilbert curve reordering", "Tiled Hilbert reordering", and the Morton
// order and bit swizzling of "Other interesting reorderings".
#pragma once
#include <optional>

#include "reorder/ordering.h"

namespace regather::reorder {

/// swizzle: a few top bits interleaved, by a table small enough for a lookup.
enum class Curve : std::uint8_t { hilbert, morton, swizzle };

struct CurveSortedConfig {
    Curve curve = Curve::hilbert;
    std::optional<std::uint32_t> tile;  ///< Edge [pixels]; none: the whole image at once.
    std::uint32_t bits = 21;            ///< An axis: 1 to 21, swizzle to 8.
};

inline constexpr std::uint32_t max_swizzle_bits = 8;

/// Positions are quantised in a cube over the bounds (reorder/cell.h). NaN and infinite positions come last
/// (of their tile). Tile number and code share 64 bits: with more than 2^15 tiles fewer than 16 bits an axis
/// are used.
class CurveSorted final : public Ordering {
public:
    explicit CurveSorted(const CurveSortedConfig& config);  ///< trace::UsageError names the field at fault.
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<std::uint64_t> keys) const override;
    BufferUse buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                         std::span<const std::uint32_t> permutation) const override;

private:
    CurveSortedConfig config_;
};

}  // namespace regather::reorder
