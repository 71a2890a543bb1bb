#include "capture/sampling/hemisphere_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capture/light/bsdf.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

/// Which of the parts that end at `ends` (ascending, the last is 1) x lies in, and how far, in [0, 1).
struct Place {
    std::size_t part;
    float within;
};
Place place_in(std::span<const float> ends, float x) {
    const auto found = std::upper_bound(ends.begin(), ends.end() - 1, x);
    const auto part = static_cast<std::size_t>(found - ends.begin());
    const float begin = part == 0 ? 0 : ends[part - 1], width = ends[part] - begin;
    // A part without width is found by no x but for rounding at the last one.
    return {part, width > 0 ? std::clamp((x - begin) / width, 0.0f, 0x1.fffffep-1f) : 0.0f};
}

/// Sums of the shares, to 1; equal parts where all shares are 0.
void accumulate(std::span<const double> shares, std::span<float> ends) {
    double sum = 0, total = 0;
    for (const double share : shares) total += share;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        sum += total > 0 ? shares[i] / total : 1.0 / static_cast<double>(shares.size());
        ends[i] = std::min(static_cast<float>(sum), 1.0f);
    }
    ends.back() = 1;
}

}  // namespace

HemisphereTable::HemisphereTable(std::uint32_t rows, std::uint32_t columns) : rows_(rows), columns_(columns) {
    if (rows < 1 || rows > most_rows || columns < 2 || columns > most_columns || columns % 2 != 0)
        throw trace::UsageError(
            fmt::format("table: found {}x{}, expected 1 to {} rows and an even number of 2 to {} columns",
                        rows, columns, most_rows, most_columns));
    up_to_row_.resize(rows);
    up_to_cell_.resize(std::size_t{rows} * columns);
    for (std::uint32_t i = 0; i < columns / 2; ++i) {
        const double angle = 2 * std::numbers::pi * i / columns;
        edge_.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0});
    }
    set(std::vector<float>(up_to_cell_.size()), 0);
}

std::uint32_t HemisphereTable::cell_of(Vec3 d) const {
    const float sine2 = d.z > 0 ? d.x * d.x + d.y * d.y : 1;
    const std::uint32_t row =
        std::min(static_cast<std::uint32_t>(sine2 * static_cast<float>(rows_)), rows_ - 1);
    // The angle about z without an arc tangent: which side of the edges the direction is on.
    const bool behind = d.y < 0 || (d.y == 0 && d.x < 0);
    const float x = behind ? -d.x : d.x, y = behind ? -d.y : d.y;
    const auto not_past = std::partition_point(edge_.begin() + 1, edge_.end(),
                                               [&](Vec3 edge) { return edge.x * y - edge.y * x >= 0; });
    const auto column = static_cast<std::uint32_t>(not_past - edge_.begin() - 1);
    return row * columns_ + column + (behind ? columns_ / 2 : 0);
}

Vec3 HemisphereTable::middle_of(std::uint32_t cell) const {
    return cosine_hemisphere((static_cast<float>(cell / columns_) + 0.5f) / static_cast<float>(rows_),
                             (static_cast<float>(cell % columns_) + 0.5f) / static_cast<float>(columns_));
}

void HemisphereTable::set(std::span<const float> shares, double floor) {
    const std::size_t cells = up_to_cell_.size();
    double total = 0;
    for (const float share : shares) total += share;
    std::vector<double> mixed(cells, 1.0 / static_cast<double>(cells)), row_shares(rows_);
    if (total > 0)
        for (std::size_t i = 0; i < cells; ++i)
            mixed[i] = (1 - floor) * shares[i] / total + floor / static_cast<double>(cells);
    for (std::uint32_t row = 0; row < rows_; ++row) {
        const std::span<const double> of_row =
            std::span(mixed).subspan(std::size_t{row} * columns_, columns_);
        for (const double share : of_row) row_shares[row] += share;
        accumulate(of_row, std::span(up_to_cell_).subspan(std::size_t{row} * columns_, columns_));
    }
    accumulate(row_shares, up_to_row_);
}

double HemisphereTable::factor_of(std::uint32_t cell) const {
    const auto width = [](const std::vector<float>& ends, std::size_t first, std::size_t i) {
        return static_cast<double>(ends[i]) - (i == first ? 0.0f : ends[i - 1]);
    };
    const std::uint32_t row = cell / columns_;
    return width(up_to_row_, 0, row) * width(up_to_cell_, std::size_t{row} * columns_, cell) * rows_ *
           columns_;
}

HemisphereTable::Found HemisphereTable::sample(float u, float v) const {
    const Place row = place_in(up_to_row_, u);
    const Place column = place_in(std::span(up_to_cell_).subspan(row.part * columns_, columns_), v);
    const Vec3 direction =
        cosine_hemisphere((static_cast<float>(row.part) + row.within) / static_cast<float>(rows_),
                          (static_cast<float>(column.part) + column.within) / static_cast<float>(columns_));
    const auto cell = static_cast<std::uint32_t>(row.part * columns_ + column.part);
    return {direction, factor_of(cell) * static_cast<double>(direction.z) * std::numbers::inv_pi};
}

double HemisphereTable::pdf(Vec3 direction) const {
    if (!(direction.z > 0)) return 0;
    return factor_of(cell_of(direction)) * static_cast<double>(direction.z) * std::numbers::inv_pi;
}

}  // namespace regather::capture
