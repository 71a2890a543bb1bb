// capture/sampling/hemisphere_table.h -- a density over the directions of a hemisphere that is the cosine's
// times a factor for each of rows x columns cells: where light comes from, as photons tell (Jensen,
// "Importance Driven Path Tracing Using the Photon Map", EGWR 1995).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "trace/vec.h"

namespace regather::capture {

using trace::Vec3;

/// Directions are of unit length in a frame whose z axis is the normal. A row is a range of sin^2 of the
/// angle to it, a column one of the angle about it: all cells have the same share of the cosine density, cos
/// / pi.
class HemisphereTable {
public:
    static constexpr std::uint32_t most_rows = 64, most_columns = 128;

    /// Throws trace::UsageError unless rows are 1 to most_rows, and columns even, 2 to most_columns.
    HemisphereTable(std::uint32_t rows, std::uint32_t columns);

    std::uint32_t rows() const { return rows_; }
    std::uint32_t columns() const { return columns_; }
    /// The cell of a direction, row by row. A direction below the horizon is in the last row.
    std::uint32_t cell_of(Vec3 direction) const;
    /// The direction in the middle of the cell.
    Vec3 middle_of(std::uint32_t cell) const;

    /// Shares of the cells, each at least 0 and finite, to a sum that need not be 1; `floor`, 0 to 1, of the
    /// density is the cosine's whatever they are, and all of it when they are all 0.
    void set(std::span<const float> shares, double floor);

    struct Found {
        Vec3 direction;
        double density;  ///< [1/sr] Of the cell that the direction was drawn in, also where it is rounded
                         ///< across an edge.
    };
    /// A direction by a point of the unit square, each coordinate in [0, 1): rows by `u`, columns in a row by
    /// `v`, both in order, so that points of different strata fall into different parts of the hemisphere.
    Found sample(float u, float v) const;
    /// [1/sr] Of a direction; 0 at and below the horizon.
    double pdf(Vec3 direction) const;

    /// What a table keeps for a point: a float for each cell's share, summed up along its row, and for each
    /// row's.
    std::uint32_t bytes() const { return 4 * (rows_ * columns_ + rows_); }

private:
    /// Over the cosine density.
    double factor_of(std::uint32_t cell) const;

    std::uint32_t rows_, columns_;
    std::vector<float> up_to_row_;   // sums of the rows' shares; the last is 1
    std::vector<float> up_to_cell_;  // sums along each row; the last of a row is 1
    std::vector<Vec3> edge_;         // where column i < columns / 2 begins: (cos, sin, 0)
};

}  // namespace regather::capture
