#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "charts/kinds.h"
#include "results/table.h"

namespace regather::charts {
namespace {

// An error of 0 has no place on a log axis: what is smaller is drawn here.
constexpr double least_drawn = 1e-18, most_drawn = 1e3;
constexpr double row_pixels = 17;

double drawn(const results::Number& value, double otherwise) {
    return std::clamp(value.value_or(otherwise), least_drawn, most_drawn);
}

Scale decades(double low, double high, int step) {
    Scale out{true, low, high, {}};
    for (double value = 1; value <= high * 1.001; value *= std::pow(10.0, step))
        out.ticks.emplace_back(value, plain_number(value));
    for (double value = std::pow(10.0, -step); value >= low; value *= std::pow(10.0, -step))
        out.ticks.insert(out.ticks.begin(), {value, fmt::format("{:.0e}", value)});
    return out;
}

Line markers(std::string label, std::string colour, int marker, double width) {
    Line line;
    line.label = std::move(label);
    line.colour = std::move(colour);
    line.marker = marker;
    line.width = width;
    line.form = Line::Form::points;
    return line;
}

}  // namespace

Chart stability(const ChartKind& kind, const results::Rows& rows, const ChartOptions&) {
    const std::vector<results::StabilityRow>& all = rows.of<results::StabilityRow>();
    if (all.empty()) return skip(fmt::format("needs {}", kind.needs));
    Panel errors, seconds;
    errors.height = seconds.height = row_pixels * static_cast<double>(all.size());
    errors.share = 3;
    errors.tick_size = 10;
    errors.across = Axis{"error", decades(least_drawn / 2, 2 * most_drawn, 3)};
    seconds.across = Axis{"seconds", decades(0.0005, 2000, 2)};
    seconds.beside = true;
    Line allowed = markers("allowed", "#303030", 2, 1.4), good = markers("measured", "#2a78b5", 7, 1.4),
         bad = markers("measured, more than allowed", "#c8321e", 13, 2.4),
         taken = markers("", "#7a7a7a", 5, 1.2);
    errors.up.scale = {false, 0.3, static_cast<double>(all.size()) + 0.7, {}};
    for (std::size_t i = 0; i < all.size(); ++i) {
        const results::StabilityRow& row = all[i];
        const auto y = static_cast<double>(all.size() - i);
        errors.up.scale.ticks.emplace_back(
            y, fmt::format("{}: {}", row.group, results::cut(row.stability_case, 52)));
        allowed.points.push_back({drawn(row.allowed_error, most_drawn), y});
        (row.passed.value_or(false) ? good : bad).points.push_back({drawn(row.error, most_drawn), y});
        if (row.seconds) taken.points.push_back({std::clamp(*row.seconds, 0.001, 1000.0), y});
    }
    seconds.up.scale = errors.up.scale;
    for (Line* line : {&allowed, &good, &bad})
        if (!line->points.empty()) errors.lines.push_back(std::move(*line));
    seconds.lines.push_back(std::move(taken));
    Figure figure{std::string(kind.title),
                  fmt::format("{} cases; an error below 1e-18 is drawn at the left edge", all.size()),
                  {},
                  {std::move(errors), std::move(seconds)}};
    figure.width = page_width;
    return draw(figure);
}

}  // namespace regather::charts
