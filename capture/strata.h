// capture/strata.h -- stratified samples of the unit square: one in each cell of a grid.
#pragma once
#include <cmath>
#include <cstdint>

#include "capture/sampler.h"

namespace regather::capture {

/// A grid of `count` equal cells: rows x columns = count, as square as the divisors of `count` allow.
struct Strata {
    explicit Strata(std::uint32_t count) {
        rows = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(count)));
        while (rows > 1 && count % rows != 0) --rows;
        columns = count / (rows > 1 ? rows : 1);
    }

    struct Point {
        float along_rows, along_columns;  ///< Each in [0, 1).
    };
    /// A random point of the cell.
    Point sample(std::uint32_t cell, Sampler& sampler) const {
        const auto place = [](std::uint32_t i, float random, std::uint32_t n) {
            return std::fmin((static_cast<float>(i) + random) / static_cast<float>(n), 0x1.fffffep-1f);
        };
        const float row = place(cell / columns, sampler.uniform(), rows);
        return {row, place(cell % columns, sampler.uniform(), columns)};
    }

    /// Where the middle of a cell lies: along the rows in the upper 16 bits, along the columns in the lower
    /// ones, in 65536ths of the square's edge. So cells of grids of any size compare.
    std::uint32_t place(std::uint32_t cell) const {
        const auto middle = [](std::uint64_t i, std::uint64_t n) {
            return static_cast<std::uint32_t>((2 * i + 1) * 32768 / n);
        };
        return middle(cell / columns, rows) << 16 | middle(cell % columns, columns);
    }

    std::uint32_t rows = 1, columns = 1;
};

}  // namespace regather::capture
