#include "charts/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "charts/caption.h"
#include "charts/figure.h"
#include "charts/plot.h"
#include "charts/series.h"

namespace regather::charts {
namespace {

std::string kib_number(double bytes) {
    return fmt::format("{:.10g}", bytes / 1024);
}
std::string square(double n) {
    return fmt::format("{0:.10g}×{0:.10g}", n);
}
const HorizontalAxis tile_axis{"tile edge [pixels]", Axis::tile, plain_number};
const HorizontalAxis bins_axis{"direction bins over the sphere", Axis::bins, square};
const HorizontalAxis cache_axis{"cache size [KiB]", Axis::cache, kib_number};

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

Chart draw_traffic(const ChartKind& kind, std::span<const Curve> drawn, const HorizontalAxis& axis,
                   const std::string& cache) {
    double most = 0;
    for (const Curve& curve : drawn)
        for (const results::Row* row : curve.rows)
            most = std::max(most, static_cast<double>(*row->traffic_bytes));
    const results::ByteUnit unit = results::byte_unit(most);
    Panel panel;
    panel.label = fmt::format("traffic from memory to cache [{}]", unit.name);
    panel.measure = [unit](const results::Row& row) {
        return std::optional(static_cast<double>(*row.traffic_bytes) / unit.bytes);
    };
    panel.tick_label = plain_number;
    if (const auto floor = compulsory(drawn)) panel.floor = *floor / unit.bytes;
    panel.floor_label = "Compulsory: each line once";
    panel.nothing = "No traffic";

    Chart chart;
    chart.title = kind.title;
    chart.caption = caption(drawn, cache);
    if (!compose_panels(chart, drawn, axis, std::span(&panel, 1))) return skip("no traffic above 0");
    return chart;
}

Chart draw_cost(const ChartKind& kind, std::span<const Curve> drawn, const HorizontalAxis& axis) {
    Panel panels[2];
    panels[0].label = "key operations per query";
    panels[0].measure = [](const results::Row& row) -> std::optional<double> {
        if (!row.key_ops || !row.queries || *row.queries == 0) return {};
        return static_cast<double>(*row.key_ops) / static_cast<double>(*row.queries);
    };
    panels[0].tick_label = plain_number;
    panels[0].nothing = "No computation";
    panels[1].label = "peak buffered bytes";
    panels[1].measure = [](const results::Row& row) -> std::optional<double> {
        if (!row.buffered_bytes) return {};
        return static_cast<double>(*row.buffered_bytes);
    };
    panels[1].tick_label = byte_number;
    panels[1].nothing = "Nothing buffered";

    Chart chart;
    chart.title = kind.title;
    chart.caption = caption(drawn, "");
    if (!compose_panels(chart, drawn, axis, panels))
        return skip("no row has key_ops with queries, or buffered_bytes, above 0");
    return chart;
}

struct Sliced {
    std::vector<Curve> curves;
    results::Geometry cache;
    std::string skipped;
};

/// The curves of a chart, or why there are none. A chart along an axis needs two places on it.
Sliced slice(const ChartKind& kind, std::span<const results::Row> rows, Axis axis,
             const ChartOptions& options) {
    const auto common = results::commonest_geometry(rows);
    Sliced out;
    if (!common) {
        out.skipped = "no row has cache_bytes, line_bytes and ways";
        return out;
    }
    out.cache = options.cache.value_or(*common);
    out.curves = curves(rows, axis, {out.cache, options.tile, options.bins, true});
    std::set<double> places;
    for (const Curve& curve : out.curves)
        for (const results::Row* row : curve.rows)
            if (!curve.flat) places.insert(axis_value(*row, axis));
    if (out.curves.empty() && axis != Axis::bins)
        out.skipped = fmt::format("no row has the cache {}", results::geometry_text(out.cache));
    else if (places.size() < 2)
        out.skipped = fmt::format("needs {}; found {} with the cache {}", kind.needs, places.size(),
                                  results::geometry_text(out.cache));
    return out;
}

}  // namespace

Chart traffic_by_tile(const ChartKind& kind, const Rows& rows, const ChartOptions& options) {
    const Sliced sliced = slice(kind, rows.measurements, Axis::tile, options);
    if (!sliced.skipped.empty()) return skip(sliced.skipped);
    std::string text = results::geometry_text(sliced.cache);
    return draw_traffic(kind, sliced.curves, tile_axis, text.insert(text.find(','), " cache"));
}

Chart traffic_by_cache(const ChartKind& kind, const Rows& rows, const ChartOptions& options) {
    const Sliced sliced = slice(kind, rows.measurements, Axis::cache, options);
    if (!sliced.skipped.empty()) return skip(sliced.skipped);
    const std::string text = results::geometry_text(sliced.cache);
    return draw_traffic(kind, sliced.curves, cache_axis, text.substr(text.find(',') + 2));
}

Chart cost_by_tile(const ChartKind& kind, const Rows& rows, const ChartOptions& options) {
    const Sliced sliced = slice(kind, rows.measurements, Axis::tile, options);
    if (!sliced.skipped.empty()) return skip(sliced.skipped);
    return draw_cost(kind, sliced.curves, tile_axis);
}

Chart cost_by_bins(const ChartKind& kind, const Rows& rows, const ChartOptions& options) {
    const Sliced sliced = slice(kind, rows.measurements, Axis::bins, options);
    if (!sliced.skipped.empty()) return skip(sliced.skipped);
    return draw_cost(kind, sliced.curves, bins_axis);
}

}  // namespace regather::charts
