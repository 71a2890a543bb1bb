// reorder/ray_sorted.h -- rays sorted by where they start and where they go: keys of origin and direction,
// and of origin and end point, as Meister, Boksansky, Guthe and Bittner compare them ("On Ray Reordering
// Techniques for Faster GPU Ray Tracing", I3D 2020, section 3).
#pragma once
#include <optional>

#include "reorder/ordering.h"

namespace regather::reorder {

/// What the key's bits are taken from in turn, the highest first.
enum class RayKey : std::uint8_t {
    origin_direction,  ///< x, y, z of the origin, then u, v of the direction on an octahedron.
    origin_end,        ///< x, y, z of the origin, then x, y, z of the end point, on one grid.
    origin_guess,      ///< The same with the end in a coarse model in place of the true one (Moon et al.,
                       ///< "Cache-Oblivious Ray Reordering", 2010, section 4). Each ray is cast through it.
};

struct RaySortedConfig {
    RayKey key = RayKey::origin_direction;
    std::optional<std::uint32_t> tile;  ///< Edge [pixels]; none: the whole image at once.
    std::uint32_t bits = 8;             ///< Of each coordinate: 1 to 12, with points to 10.
};

/// Rays with an origin, a direction or an end that is not finite come last (of their tile). The rays of the
/// image, or of a tile, are collected, then sorted. Tile number and key share 64 bits: with many tiles fewer
/// bits of a coordinate are used.
class RaySorted final : public Ordering {
public:
    explicit RaySorted(const RaySortedConfig& config);  ///< trace::UsageError names the field at fault.
    Reads reads() const override;
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<std::uint64_t> keys) const override;
    BufferUse buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                         std::span<const std::uint32_t> permutation) const override;

private:
    RaySortedConfig config_;
};

}  // namespace regather::reorder
