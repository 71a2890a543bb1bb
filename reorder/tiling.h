// reorder/tiling.h -- square tiles of the image: which tile a pixel lies in, and where in it. The paper,
// section 6.3.1.
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

#include "reorder/ordering.h"
#include "trace/range.h"

namespace regather::reorder {

inline constexpr std::uint32_t max_tile = 65536;  ///< Its square fits 32 bits.

/// Tiles in row order, clipped at the right and lower edges of the image. Without an edge the image is one
/// tile.
class Tiling {
public:
    Tiling(const Workload& work, std::optional<std::uint32_t> edge)
        : width_(work.image_width),
          height_(work.image_height),
          edge_(edge.value_or(std::max(width_, height_))),
          columns_((width_ - 1) / edge_ + 1) {}

    std::uint64_t tiles() const { return std::uint64_t{columns_} * ((height_ - 1) / edge_ + 1); }
    std::uint32_t tile_of(std::uint32_t pixel) const {
        return pixel / width_ / edge_ * columns_ + pixel % width_ / edge_;
    }
    std::uint32_t column_in_tile(std::uint32_t pixel) const { return pixel % width_ % edge_; }
    std::uint32_t row_in_tile(std::uint32_t pixel) const { return pixel / width_ % edge_; }
    /// Of a tile that is not clipped, or of the image when that is smaller.
    std::uint64_t pixels_in_tile() const {
        return std::uint64_t{std::min(edge_, width_)} * std::min(edge_, height_);
    }

private:
    std::uint32_t width_, height_, edge_, columns_;
};

/// Throws trace::UsageError unless 1 <= tile <= max_tile.
inline void require_tile(std::string_view ordering, std::optional<std::uint32_t> tile) {
    if (tile) trace::require_range(ordering, "tile", *tile, 1, max_tile);
}

}  // namespace regather::reorder
