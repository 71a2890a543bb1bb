// capture/irradiance/hemisphere_grid.h -- strata of the hemisphere that all have the same share of the cosine
// density: rows by the angle to the normal, columns about it (Ward & Heckbert, "Irradiance Gradients", EGWR
// 1992).
#pragma once
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "trace/vec.h"

namespace regather::capture {

using trace::Vec3;
using trace::Vec3d;

/// What one stratum's ray brings.
struct Incoming {
    Vec3 direction;             ///< Unit length, pointing away from the surface, in world space.
    Vec3 radiance;              ///< [W / (m^2 sr)]
    float distance = INFINITY;  ///< To what sends it [scene units]; infinite where nothing is met.
};

/// Row j holds the directions whose sin^2 of the angle to the normal is j / rows to (j + 1) / rows, column k
/// those whose angle about it is k / columns to (k + 1) / columns of a turn. Cells are numbered row by row.
/// What gradients need of rows and columns is kept: integrals over a cell, so that light that is constant
/// over each cell has exact ones, however few the cells.
class HemisphereGrid {
public:
    static constexpr std::uint32_t most_rows = 256, most_columns = 1024;

    /// Throws trace::UsageError unless rows are 1 to most_rows and columns 3 to most_columns.
    HemisphereGrid(std::uint32_t rows, std::uint32_t columns);
    /// About `samples` cells that are about as wide as high: columns = pi rows (Ward & Heckbert).
    static HemisphereGrid of(std::uint32_t samples);

    std::uint32_t rows() const { return rows_; }
    std::uint32_t columns() const { return columns_; }
    std::uint32_t cells() const { return rows_ * columns_; }
    /// A direction of the cell by two numbers in [0, 1), of unit length where the normal is z.
    Vec3 direction(std::uint32_t cell, float u, float v) const;

    /// Where the middle of the cell lies, as Strata::place().
    std::uint32_t place(std::uint32_t cell) const {
        const auto middle = [](std::uint64_t i, std::uint64_t n) {
            return static_cast<std::uint32_t>((2 * i + 1) * 32768 / n);
        };
        return middle(cell / columns_, rows_) << 16 | middle(cell % columns_, columns_);
    }

    /// In a frame whose z axis is the normal. theta: the angle to it, phi: the angle about it.
    struct Row {
        double upper_sine;  ///< Of theta where the row begins.
        double upper_edge;  ///< sin(theta) cos^2(theta) there.
        double width;       ///< sin(theta) where it ends, less that where it begins.
        double turning;     ///< The integral of sin^2(theta) over theta.
    };
    struct Column {
        Vec3d outward;   ///< The integral of (cos(phi), sin(phi), 0) over phi.
        Vec3d around;    ///< The integral of (-sin(phi), cos(phi), 0) over phi.
        Vec3d at_begin;  ///< (-sin(phi), cos(phi), 0) where the column begins.
    };
    std::span<const Row> row() const { return row_; }
    std::span<const Column> column() const { return column_; }

private:
    std::uint32_t rows_, columns_;
    std::vector<Row> row_;
    std::vector<Column> column_;
};

}  // namespace regather::capture
