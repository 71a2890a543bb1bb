// spatial/photons/cell_planes.h -- space cut into cells of one size by planes across each axis, and the cells
// around a point, shell by shell. Lengths in scene units.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "trace/bounds.h"

namespace regather::spatial {

using trace::Vec3;

/// Cells along x, y and z.
using CellPlace = std::array<std::uint32_t, 3>;

class CellPlanes {
public:
    /// `along` cells, 1 to 2^20, along the longest side of the box, and as many of that size as cover it
    /// along the others. An empty box is one cell at the origin.
    CellPlanes(const trace::Bounds3& box, std::uint32_t along);

    /// Cells along an axis.
    std::uint32_t count(int axis) const { return static_cast<std::uint32_t>(planes_[axis].size() - 1); }
    std::uint64_t cells() const { return std::uint64_t{count(0)} * count(1) * count(2); }
    std::uint64_t number(const CellPlace& cell) const {
        return (std::uint64_t{cell[2]} * count(1) + cell[1]) * count(0) + cell[0];
    }
    CellPlace place(std::uint64_t number) const;
    /// The cell that a point of the box lies in; of any other point the one that is next to it.
    CellPlace cell_of(Vec3 point) const;
    /// From a point to the nearest point of the cell, squared; never more than what is computed in the same
    /// way for a point of the box whose cell_of() it is.
    float distance2(const CellPlace& cell, Vec3 point) const {
        const Vec3 d{distance(0, cell[0], point.x), distance(1, cell[1], point.y),
                     distance(2, cell[2], point.z)};
        return trace::dot(d, d);
    }

    /// Calls visit(cell) for the cells around the point's own, in shells of equal steps along the farthest
    /// axis, each shell by z, y and x, and of these only those within `bound()`, a squared distance that may
    /// shrink meanwhile. Ends when nothing farther out can be within it. Before a shell of more than
    /// `most_cells` cells it calls rest(steps) instead and ends: the cells from so many steps on are left.
    template <class Bound, class Visit, class Rest>
    void for_each_near(Vec3 point, Bound&& bound, Visit&& visit, std::uint64_t most_cells, Rest&& rest) const;

private:
    using Steps = std::int64_t;

    float distance(int axis, std::uint32_t cell, float x) const {
        const float lower = planes_[axis][cell], upper = planes_[axis][cell + 1];
        return x < lower ? lower - x : x > upper ? x - upper : 0;
    }
    /// Cells up to so many steps from a cell.
    std::uint64_t block(const CellPlace& home, Steps steps) const {
        if (steps < 0) return 0;
        std::uint64_t cells = 1;
        for (int axis = 0; axis < 3; ++axis)
            cells *= static_cast<std::uint64_t>(last(axis, home, steps) - first(axis, home, steps) + 1);
        return cells;
    }
    Steps first(int axis, const CellPlace& home, Steps steps) const {
        return std::max<Steps>(0, home[axis] - steps);
    }
    Steps last(int axis, const CellPlace& home, Steps steps) const {
        return std::min<Steps>(count(axis) - Steps{1}, home[axis] + steps);
    }
    /// Whether anything so many steps from a point's cell, or farther, can be within the bound.
    bool reaches(Vec3 point, const CellPlace& home, Steps steps, float bound) const {
        for (int axis = 0; axis < 3; ++axis) {
            const float x = point[axis];
            if (home[axis] >= steps) {
                const float d = x - planes_[axis][static_cast<std::size_t>(home[axis] - steps + 1)];
                if (d * d <= bound) return true;
            }
            if (home[axis] + steps < count(axis)) {
                const float d = planes_[axis][static_cast<std::size_t>(home[axis] + steps)] - x;
                if (d * d <= bound) return true;
            }
        }
        return false;
    }

    std::array<std::vector<float>, 3> planes_;
};

template <class Bound, class Visit, class Rest>
void CellPlanes::for_each_near(Vec3 point, Bound&& bound, Visit&& visit, std::uint64_t most_cells,
                               Rest&& rest) const {
    const CellPlace home = cell_of(point);
    for (Steps r = 0;; ++r) {
        if (r > 0 && !reaches(point, home, r, bound())) return;
        if (block(home, r) - block(home, r - 1) > most_cells) {
            rest(static_cast<std::uint32_t>(r));
            return;
        }
        const auto at_edge = [&](int axis, Steps cell) {
            return cell == home[axis] - r || cell == home[axis] + r;
        };
        const Steps left = home[0] - r, right = home[0] + r;
        const bool has_sides = left >= 0 || right < count(0);
        CellPlace cell;
        const auto visit_near = [&](Steps x) {
            cell[0] = static_cast<std::uint32_t>(x);
            if (distance2(cell, point) <= bound()) visit(cell);
        };
        for (Steps z = first(2, home, r); z <= last(2, home, r); ++z) {
            cell[2] = static_cast<std::uint32_t>(z);
            const float dz = distance(2, cell[2], point.z);
            if (dz * dz > bound()) continue;
            for (Steps y = first(1, home, r); y <= last(1, home, r); ++y) {
                const bool whole_row = at_edge(2, z) || at_edge(1, y);
                if (!whole_row && !has_sides) {  // up to the shell's other edge there is nothing
                    y = std::min(last(1, home, r), home[1] + r - 1);
                    continue;
                }
                cell[1] = static_cast<std::uint32_t>(y);
                const float dy = distance(1, cell[1], point.y);
                if (dy * dy > bound()) continue;
                if (whole_row) {
                    for (Steps x = first(0, home, r); x <= last(0, home, r); ++x) visit_near(x);
                } else {
                    if (left >= 0) visit_near(left);
                    if (right < count(0)) visit_near(right);
                }
            }
        }
    }
}

/// The most cells along the longest side of a box for which there are at most `cells`, 1 to 2^32, in all.
std::uint32_t cells_along(const trace::Bounds3& box, std::uint64_t cells);

}  // namespace regather::spatial
