#include "capture/irradiance/hemisphere_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "capture/light/bsdf.h"
#include "trace/error.h"

namespace regather::capture {

HemisphereGrid::HemisphereGrid(std::uint32_t rows, std::uint32_t columns) : rows_(rows), columns_(columns) {
    if (rows < 1 || rows > most_rows || columns < 3 || columns > most_columns)
        throw trace::UsageError(
            fmt::format("hemisphere: found {} x {} cells, expected 1 to {} rows and 3 to {} columns", rows,
                        columns, most_rows, most_columns));
    for (std::uint32_t j = 0; j < rows; ++j) {
        const auto sine2 = [&](std::uint32_t edge) { return static_cast<double>(edge) / rows; };
        const auto turned = [](double s) { return (std::asin(std::sqrt(s)) - std::sqrt(s * (1 - s))) / 2; };
        const double begin = sine2(j), end = sine2(j + 1);
        row_.push_back({std::sqrt(begin), std::sqrt(begin) * (1 - begin), std::sqrt(end) - std::sqrt(begin),
                        turned(end) - turned(begin)});
    }
    const auto outward = [&](std::uint32_t edge) {
        const double phi = 2 * std::numbers::pi * edge / columns;
        return Vec3d{std::cos(phi), std::sin(phi), 0};
    };
    for (std::uint32_t k = 0; k < columns; ++k) {
        const Vec3d begin = outward(k), end = outward(k + 1 == columns ? 0 : k + 1), step = end - begin;
        column_.push_back({{step.y, -step.x, 0}, step, {-begin.y, begin.x, 0}});
    }
}

HemisphereGrid HemisphereGrid::of(std::uint32_t samples) {
    const double rows = std::sqrt(std::max(samples, 1u) / std::numbers::pi);
    const auto j = static_cast<std::uint32_t>(std::clamp<long>(std::lround(rows), 1, most_rows));
    return {j, std::clamp(samples / j, 3u, most_columns)};
}

Vec3 HemisphereGrid::direction(std::uint32_t cell, float u, float v) const {
    const auto place = [](std::uint32_t before, float within, std::uint32_t all) {
        return std::fmin((static_cast<float>(before) + within) / static_cast<float>(all), 0x1.fffffep-1f);
    };
    return cosine_hemisphere(place(cell / columns_, u, rows_), place(cell % columns_, v, columns_));
}

}  // namespace regather::capture
