#include "charts/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "charts/caption.h"
#include "trace/median.h"

namespace regather::charts {
namespace {

constexpr double single_height = 300, double_height = 190;
constexpr std::size_t most_ticks = 14;

std::string square(double n) {
    return fmt::format("{0:.10g}×{0:.10g}", n);
}

struct Across {
    const char* label;
    std::string (*tick_label)(double);
};
Across across(Along along) {
    switch (along) {
        case Along::tile:
            return {"tile edge [pixels]", plain_number};
        case Along::bins:
            return {"direction bins over the sphere, or strata", square};
        case Along::cache:
            break;
    }
    return {"cache size [KiB]", kib_number};
}

std::vector<const results::Row*> frames_at(const Curve& curve, std::size_t r) {
    return r < curve.frames.size() ? curve.frames[r] : std::vector<const results::Row*>{curve.rows[r]};
}

/// A curve as one panel shows it: places above 0 only, as a log axis has no 0.
std::vector<Point> points(const Curve& curve, const Measure& measure, Along along) {
    std::vector<Point> out;
    for (std::size_t r = 0; r < curve.rows.size(); ++r) {
        std::vector<double> found;
        for (const results::Row* row : frames_at(curve, r))
            if (const auto y = measure.of(*row); y && *y > 0) found.push_back(*y);
        if (found.empty()) continue;
        const auto [least, most] = std::minmax_element(found.begin(), found.end());
        Point point{curve.flat ? 0 : axis_value(*curve.rows[r], along), trace::median(found)};
        if (*least < *most) {
            point.low = *least;
            point.high = *most;
        }
        out.push_back(point);
    }
    return out;
}

bool all_zero(const Curve& curve, const Measure& measure) {
    return std::all_of(curve.rows.begin(), curve.rows.end(),
                       [&](const results::Row* row) { return measure.of(*row) == std::optional<double>(0); });
}

/// Curves from the top of the picture downwards, as they leave it at the right.
std::vector<const Curve*> legend_order(std::span<const Curve> curves, std::span<const Measure> measures,
                                       Along along) {
    std::vector<std::pair<double, const Curve*>> heights;
    for (const Curve& curve : curves)
        for (const Measure& measure : measures)
            if (const auto shown = points(curve, measure, along); !shown.empty()) {
                // Curves that only a lower panel shows come after all of the first one's.
                const bool first = &measure == &measures.front();
                heights.emplace_back(std::log(shown.back().y) + (first ? 1000 : 0), &curve);
                break;
            }
    std::stable_sort(heights.begin(), heights.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<const Curve*> out;
    for (const auto& [height, curve] : heights) out.push_back(curve);
    return out;
}

/// A tick at each place that was measured.
Scale across_scale(std::span<const Curve> curves, Along along) {
    std::set<double> places;
    for (const Curve& curve : curves)
        for (const results::Row* row : curve.rows)
            if (!curve.flat) places.insert(axis_value(*row, along));
    Scale out{true};
    if (places.empty()) return out;
    // A margin of a fifteenth of the width, so that markers on level lines stand clear of the curves' ends.
    const double margin = std::pow(std::max(2.0, *places.rbegin() / *places.begin()), 1.0 / 15);
    out.low = *places.begin() / margin;
    out.high = *places.rbegin() * margin;
    const std::size_t every = 1 + (places.size() - 1) / most_ticks;
    std::size_t left = places.size();
    for (const double place : places)  // every so many, keeping the last
        if (--left % every == 0) out.ticks.emplace_back(place, across(along).tick_label(place));
    return out;
}

Scale up_scale(std::span<const double> values, std::string (*label)(double)) {
    if (values.empty()) return {true, 1, 10, {}};
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    Scale out{true, 0.75 * *least, 1.3 * *most, {}};
    for (const double tick : log_ticks(out.low, out.high))
        if (tick >= out.low && tick <= out.high) out.ticks.emplace_back(tick, label(tick));
    return out;
}

Panel panel_of(const Measure& measure, std::span<const Curve> all, std::span<const Curve* const> order,
               Along along) {
    Panel panel;
    std::vector<double> values;
    for (const Curve* curve : order) {
        Line line = line_of(*curve);
        line.points = points(*curve, measure, along);
        if (curve->flat) {
            line.form = Line::Form::level;
            line.width = 1.3;
        }
        for (const Point& point : line.points)
            for (const double value : {point.y, point.low, point.high})
                if (!std::isnan(value)) values.push_back(value);
        panel.lines.push_back(std::move(line));
    }
    if (measure.floor) {
        Line floor;
        floor.label = measure.floor_label;
        floor.colour = "#606060";
        floor.width = 0.8;
        floor.form = Line::Form::rule;
        floor.points = {{0, *measure.floor}};
        values.push_back(*measure.floor);
        panel.lines.push_back(std::move(floor));
    }
    panel.up = {measure.label, up_scale(values, measure.tick_label)};
    std::string zeros;
    for (const Curve& curve : all)
        if (all_zero(curve, measure)) zeros += (zeros.empty() ? "" : "; ") + curve.label;
    if (!zeros.empty()) panel.remark = measure.nothing + ": " + zeros;
    return panel;
}

/// Distinct lines x line size, when all curves agree on it.
std::optional<double> compulsory(std::span<const Curve> curves) {
    std::set<std::uint64_t> seen;
    for (const Curve& curve : curves)
        for (const auto& frames : curve.frames)
            for (const results::Row* row : frames)
                if (row->compulsory_bytes) seen.insert(*row->compulsory_bytes);
    if (seen.size() != 1 || *seen.begin() == 0) return {};
    return static_cast<double>(*seen.begin());
}

}  // namespace

Sweep sweep(const ChartKind& kind, std::span<const results::Row> rows, Along along,
            const ChartOptions& options) {
    const auto common = results::commonest_geometry(rows);
    Sweep out{along};
    if (!common) {
        out.skipped = "no row has cache_bytes, line_bytes and ways";
        return out;
    }
    out.cache = options.cache.value_or(*common);
    out.curves = curves(rows, along, {out.cache, options.tile, options.bins, true});
    std::set<double> places;
    for (const Curve& curve : out.curves)
        for (const results::Row* row : curve.rows)
            if (!curve.flat) places.insert(axis_value(*row, along));
    if (out.curves.empty() && along != Along::bins)
        out.skipped = fmt::format("no row has the cache {}", results::geometry_text(out.cache));
    else if (places.size() < 2)
        out.skipped = fmt::format("needs {}; found {} with the cache {}", kind.needs, places.size(),
                                  results::geometry_text(out.cache));
    return out;
}

std::optional<Chart> draw(const Sweep& sweep, const std::string& title, const std::string& caption,
                          std::span<const Measure> measures) {
    const std::vector<const Curve*> order = legend_order(sweep.curves, measures, sweep.along);
    if (order.empty()) return {};
    Figure figure{title, caption, {across(sweep.along).label, across_scale(sweep.curves, sweep.along)}};
    for (const Measure& measure : measures) {
        Panel panel = panel_of(measure, sweep.curves, order, sweep.along);
        panel.height = measures.size() == 1 ? single_height : double_height;
        figure.panels.push_back(std::move(panel));
    }
    return draw(figure);
}

Chart draw_traffic(const ChartKind& kind, const Sweep& sweep, const std::string& cache) {
    double most = 0;
    for (const Curve& curve : sweep.curves)
        for (const results::Row* row : curve.rows)
            most = std::max(most, static_cast<double>(*row->traffic_bytes));
    const results::ByteUnit unit = results::byte_unit(most);
    Measure measure{fmt::format("traffic from memory to cache [{}]", unit.name),
                    [unit](const results::Row& row) {
                        return std::optional(static_cast<double>(*row.traffic_bytes) / unit.bytes);
                    },
                    plain_number, "No traffic"};
    if (const auto floor = compulsory(sweep.curves)) measure.floor = *floor / unit.bytes;
    measure.floor_label = "Compulsory: each line once";
    const auto chart =
        draw(sweep, std::string(kind.title), caption(sweep.curves, cache), std::span(&measure, 1));
    return chart ? *chart : skip("no traffic above 0");
}

Chart draw_cost(const ChartKind& kind, const Sweep& sweep) {
    const Measure measures[] = {{"key operations per query",
                                 [](const results::Row& row) -> std::optional<double> {
                                     if (!row.key_ops || row.queries.value_or(0) == 0) return {};
                                     return static_cast<double>(*row.key_ops) /
                                            static_cast<double>(*row.queries);
                                 },
                                 plain_number, "No computation"},
                                {"peak buffered bytes",
                                 [](const results::Row& row) -> std::optional<double> {
                                     if (!row.buffered_bytes) return {};
                                     return static_cast<double>(*row.buffered_bytes);
                                 },
                                 byte_number, "Nothing buffered"}};
    const auto chart = draw(sweep, std::string(kind.title), caption(sweep.curves, ""), measures);
    return chart ? *chart : skip("no row has key_ops with queries, or buffered_bytes, above 0");
}

}  // namespace regather::charts
