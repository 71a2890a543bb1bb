// spatial/cell.h -- cubic cells over the bounding box of positions.
// The cube has the longest edge of the box, so that cells are as long on each axis and near in cells is near
// in space.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "trace/bounds.h"

namespace regather::spatial {

using Cell = std::array<std::uint32_t, 3>;

/// Computes in double: monotone on each axis whatever the proportions of the box. Positions outside are
/// clamped to the nearest cell. An empty, one-point or non-finite box has one cell.
class CellGrid {
public:
    /// Operations of cell_of(): on each axis subtract, multiply, clamp twice, convert.
    static constexpr std::uint64_t ops = 15;

    CellGrid(const trace::Bounds3& bounds, std::uint32_t cells_per_axis) : last_(cells_per_axis - 1) {
        if (bounds.empty() || !is_finite(bounds.min) || !is_finite(bounds.max)) return;
        double edge = 0;
        for (int axis = 0; axis < 3; ++axis) {
            min_[axis] = bounds.min[axis];
            edge = std::max(edge, double{bounds.max[axis]} - min_[axis]);
        }
        if (edge > 0) scale_ = cells_per_axis / edge;
    }

    /// Any cell for a position that is not finite.
    Cell cell_of(trace::Vec3 position) const {
        return {along(position.x, 0), along(position.y, 1), along(position.z, 2)};
    }

    /// The cell's coordinate on one axis.
    std::uint32_t along(float coordinate, int axis) const {
        const double cells = (double{coordinate} - min_[axis]) * scale_;
        const double clamped = cells > 0 ? (cells < last_ ? cells : last_) : 0;  // NaN: 0
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(clamped));   // which vectors can
    }

private:
    double min_[3]{}, scale_ = 0, last_;
};

}  // namespace regather::spatial
