// capture/sampling/strata.h -- stratified samples of the unit square: one in each of so many cells of equal
// area.
#pragma once
#include <cmath>
#include <cstdint>

#include "capture/sampler.h"

namespace regather::capture {

/// Of a count whose divisors make no grid that is near a square.
enum class StrataShape : std::uint8_t {
    grid,  ///< A grid all the same: a prime count is one row.
    even,  ///< Rows of unequal numbers of cells.
};

/// `count` > 0 cells of equal area. A grid of rows x columns = count, as square as the divisors of `count`
/// allow; where that would be more than three times as long as wide and `shape` is even, the square root of
/// `count`, rounded, of rows, each with count / rows cells or one more and as high as it has cells.
struct Strata {
    explicit Strata(std::uint32_t cells, StrataShape shape = StrataShape::grid) : count(cells) {
        rows = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(count)));
        while (rows > 1 && count % rows != 0) --rows;
        columns = count / (rows > 1 ? rows : 1);
        if (shape == StrataShape::grid || columns <= 3 * rows) return;
        rows = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(count))));
        columns = count / rows;
        longer = count % rows;
    }

    struct Point {
        float along_rows, along_columns;  ///< Each in [0, 1).
    };
    /// A random point of the cell.
    Point sample(std::uint32_t cell, Sampler& sampler) const {
        const auto place = [](float cells_before, float random, std::uint32_t n) {
            return std::fmin((cells_before + random) / static_cast<float>(n), 0x1.fffffep-1f);
        };
        const Row row = row_of(cell);
        const float down = sampler.uniform();
        const float along_rows =
            longer == 0 ? place(static_cast<float>(cell / columns), down, rows)
                        : place(static_cast<float>(row.begin), down * static_cast<float>(row.cells), count);
        return {along_rows, place(static_cast<float>(cell - row.begin), sampler.uniform(), row.cells)};
    }

    /// Where the middle of a cell lies: along the rows in the upper 16 bits, along the columns in the lower
    /// ones, in 65536ths of the square's edge. So cells of grids of any size compare.
    std::uint32_t place(std::uint32_t cell) const {
        const auto middle = [](std::uint64_t twice, std::uint64_t n) {
            return static_cast<std::uint32_t>(twice * 32768 / n);
        };
        const Row row = row_of(cell);
        const std::uint32_t down = longer == 0 ? middle(2 * (cell / columns) + 1, rows)
                                               : middle(2 * std::uint64_t{row.begin} + row.cells, count);
        return down << 16 | middle(2 * (cell - row.begin) + 1, row.cells);
    }

    std::uint32_t count = 1, rows = 1, columns = 1;
    std::uint32_t longer = 0;  ///< Rows, the first ones, that have a cell more than `columns`.

private:
    struct Row {
        std::uint32_t begin, cells;  // its first cell; how many
    };
    Row row_of(std::uint32_t cell) const {
        const std::uint32_t of_longer = longer * (columns + 1);
        if (cell < of_longer) return {cell / (columns + 1) * (columns + 1), columns + 1};
        return {of_longer + (cell - of_longer) / columns * columns, columns};
    }
};

}  // namespace regather::capture
