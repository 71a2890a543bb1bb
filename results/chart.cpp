#include "results/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "results/gnuplot.h"
#include "results/plot.h"
#include "results/series.h"
#include "trace/error.h"
#include "trace/file.h"

namespace regather::results {
namespace {

std::string plain_number(double value) {
    return fmt::format("{:.10g}", value);
}
std::string kib_number(double bytes) {
    return fmt::format("{:.10g}", bytes / 1024);
}
std::string square(double n) {
    return fmt::format("{0:.10g}×{0:.10g}", n);
}
std::string byte_text(double bytes) {
    int step = 0;
    constexpr const char* units[] = {"B", "kB", "MB", "GB", "TB", "PB", "EB"};
    while (bytes >= 1000 * (1 - 1e-9) && step < 6) {
        bytes /= 1000;
        ++step;
    }
    return fmt::format("{:.4g} {}", bytes, units[step]);
}

const HorizontalAxis tile_axis{"tile edge [pixels]", Axis::tile, plain_number};
const HorizontalAxis bins_axis{"direction bins over the sphere", Axis::bins, square};
const HorizontalAxis cache_axis{"cache size [KiB]", Axis::cache, kib_number};

/// The decimal unit in which the largest traffic is at least 1.
struct Unit {
    const char* name;
    double bytes;
};
Unit unit_for(double most) {
    for (const Unit unit : {Unit{"GB", 1e9}, Unit{"MB", 1e6}, Unit{"kB", 1e3}})
        if (most >= unit.bytes) return unit;
    return {"bytes", 1};
}

/// The values of a column over all curves, "a, b" when there are several.
template <class Text>
std::string all_values(std::span<const Curve> curves, Text text) {
    std::vector<std::string> seen;
    for (const Curve& curve : curves)
        for (const Row* row : curve.rows)
            if (const std::string value = text(*row);
                !value.empty() && std::find(seen.begin(), seen.end(), value) == seen.end())
                seen.push_back(value);
    return joined(seen, " and ");
}

/// `cache`: its shape, or empty where the cache does not matter.
std::string caption(std::span<const Curve> curves, const std::string& cache) {
    std::string queries = all_values(curves, [](const Row& row) {
        return row.queries ? decimal_count(static_cast<double>(*row.queries)) : std::string();
    });
    if (!queries.empty()) queries += " queries";
    std::vector<std::string> parts = {all_values(curves, [](const Row& row) { return row.scene; }), queries};
    if (!cache.empty()) {
        const std::string policy =
            all_values(curves, [](const Row& row) { return row.policy == "lru" ? "LRU" : row.policy; });
        parts.push_back(policy.empty() ? cache : fmt::format("{} {}", cache, policy));
        parts.push_back(all_values(curves, [](const Row& row) { return row.structure; }));
        parts.push_back(all_values(curves, [](const Row& row) { return row.layout; }));
    }
    return joined(parts, " · ");
}

Chart skip(std::string reason) {
    Chart chart;
    chart.skipped = std::move(reason);
    return chart;
}

/// Distinct lines x line size, when all curves agree on it.
std::optional<double> compulsory(std::span<const Curve> curves) {
    std::set<std::uint64_t> seen;
    for (const Curve& curve : curves)
        for (const Row* row : curve.rows)
            if (row->compulsory_bytes) seen.insert(*row->compulsory_bytes);
    if (seen.size() != 1 || *seen.begin() == 0) return {};
    return static_cast<double>(*seen.begin());
}

Chart draw_traffic(const ChartKind& kind, std::span<const Curve> drawn, const HorizontalAxis& axis,
                   const std::string& cache) {
    double most = 0;
    for (const Curve& curve : drawn)
        for (const Row* row : curve.rows) most = std::max(most, static_cast<double>(*row->traffic_bytes));
    const Unit unit = unit_for(most);
    Panel panel;
    panel.label = fmt::format("traffic from memory to cache [{}]", unit.name);
    panel.measure = [unit](const Row& row) {
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
    panels[0].measure = [](const Row& row) -> std::optional<double> {
        if (!row.key_ops || !row.queries || *row.queries == 0) return {};
        return static_cast<double>(*row.key_ops) / static_cast<double>(*row.queries);
    };
    panels[0].tick_label = plain_number;
    panels[0].nothing = "No computation";
    panels[1].label = "peak buffered bytes";
    panels[1].measure = [](const Row& row) -> std::optional<double> {
        if (!row.buffered_bytes) return {};
        return static_cast<double>(*row.buffered_bytes);
    };
    panels[1].tick_label = byte_text;
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
    Geometry cache;
    std::string skipped;
};

/// The curves of a chart, or why there are none. A chart along an axis needs two places on it.
Sliced slice(const ChartKind& kind, std::span<const Row> rows, Axis axis, const ChartOptions& options) {
    const auto common = commonest_geometry(rows);
    Sliced out;
    if (!common) {
        out.skipped = "no row has cache_bytes, line_bytes and ways";
        return out;
    }
    out.cache = options.cache.value_or(*common);
    out.curves = curves(rows, axis, {out.cache, options.tile, options.bins});
    std::set<double> places;
    for (const Curve& curve : out.curves)
        for (const Row* row : curve.rows)
            if (!curve.flat) places.insert(axis_value(*row, axis));
    if (out.curves.empty() && axis != Axis::bins)
        out.skipped = fmt::format("no row has the cache {}", geometry_text(out.cache));
    else if (places.size() < 2)
        out.skipped = fmt::format("needs {}; found {} with the cache {}", kind.needs, places.size(),
                                  geometry_text(out.cache));
    return out;
}

Chart traffic_by_tile(const ChartKind& kind, std::span<const Row> rows, const ChartOptions& options) {
    const Sliced sliced = slice(kind, rows, Axis::tile, options);
    if (!sliced.skipped.empty()) return skip(sliced.skipped);
    std::string text = geometry_text(sliced.cache);
    return draw_traffic(kind, sliced.curves, tile_axis, text.insert(text.find(','), " cache"));
}

Chart traffic_by_cache(const ChartKind& kind, std::span<const Row> rows, const ChartOptions& options) {
    const Sliced sliced = slice(kind, rows, Axis::cache, options);
    if (!sliced.skipped.empty()) return skip(sliced.skipped);
    const std::string text = geometry_text(sliced.cache);
    return draw_traffic(kind, sliced.curves, cache_axis, text.substr(text.find(',') + 2));
}

Chart cost_by_tile(const ChartKind& kind, std::span<const Row> rows, const ChartOptions& options) {
    const Sliced sliced = slice(kind, rows, Axis::tile, options);
    if (!sliced.skipped.empty()) return skip(sliced.skipped);
    return draw_cost(kind, sliced.curves, tile_axis);
}

Chart cost_by_bins(const ChartKind& kind, std::span<const Row> rows, const ChartOptions& options) {
    const Sliced sliced = slice(kind, rows, Axis::bins, options);
    if (!sliced.skipped.empty()) return skip(sliced.skipped);
    return draw_cost(kind, sliced.curves, bins_axis);
}

constexpr ChartKind kinds_table[] = {
    {"traffic-by-tile", "Memory traffic by tile size", "at least 2 tile sizes", traffic_by_tile},
    {"traffic-by-cache", "Memory traffic by cache size", "at least 2 cache sizes", traffic_by_cache},
    {"cost-by-tile", "Cost of reordering by tile size", "at least 2 tile sizes", cost_by_tile},
    {"cost-by-bins", "Cost of reordering by number of direction bins", "at least 2 numbers of bins",
     cost_by_bins},
};

std::string xml_text(std::string_view text) {
    std::string out;
    for (const char c : text)
        out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return out;
}

void replace_element(std::string& svg, const std::string& name, std::string_view text) {
    const std::string open = '<' + name + '>', close = "</" + name + '>';
    const auto from = svg.find(open), to = svg.find(close);
    if (from == svg.npos || to == svg.npos) return;
    svg.replace(from + open.size(), to - from - open.size(), xml_text(text));
}

}  // namespace

std::span<const ChartKind> chart_kinds() {
    return kinds_table;
}

const ChartKind& chart_kind(std::string_view name) {
    std::string names;
    for (const ChartKind& kind : kinds_table) {
        if (kind.name == name) return kind;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", kind.name);
    }
    throw trace::UsageError(fmt::format("chart \"{}\" is not known, expected one of {}", name, names));
}

std::string script(const Chart& chart, Picture picture) {
    return picture == Picture::svg
               ? fmt::format("set terminal svg size {},{} font 'DejaVu Sans,13' background '#ffffff'\n{}",
                             chart.width, chart.height, chart.commands)
               : fmt::format(
                     "set terminal pngcairo size {},{} font 'DejaVu Sans,13' fontscale 1.5 linewidth 2 "
                     "pointscale 2 background '#ffffff'\n{}",
                     2 * chart.width, 2 * chart.height, chart.commands);
}

std::string render(const Chart& chart, Picture picture) {
    std::string bytes = run_gnuplot(script(chart, picture));
    if (!bytes.starts_with(picture == Picture::svg ? "<?xml" : "\x89PNG"))
        throw std::runtime_error(
            "gnuplot: gave no picture; expected gnuplot 5.4 with the terminals svg and pngcairo");
    if (picture == Picture::svg) {  // gnuplot's own name and version there would differ by machine
        replace_element(bytes, "title", chart.title);
        replace_element(bytes, "desc", chart.caption);
    }
    return bytes;
}

std::vector<Drawn> write_charts(const std::filesystem::path& folder, std::span<const Row> rows,
                                std::span<const std::string> kinds, const ChartOptions& options) {
    std::vector<const ChartKind*> wanted;
    for (const std::string& name : kinds) wanted.push_back(&chart_kind(name));
    if (wanted.empty())
        for (const ChartKind& kind : kinds_table) wanted.push_back(&kind);
    std::vector<Drawn> out;
    for (const ChartKind* kind : wanted) {
        const Chart chart = kind->compose(*kind, rows, options);
        Drawn& drawn = out.emplace_back(Drawn{kind->name, {}, chart.skipped});
        if (!chart.skipped.empty()) continue;
        for (const auto& [picture, ending] :
             {std::pair{Picture::svg, "svg"}, std::pair{Picture::png, "png"}}) {
            drawn.files.push_back(folder / fmt::format("{}.{}", kind->name, ending));
            trace::write_file(drawn.files.back(), render(chart, picture));
        }
    }
    return out;
}

}  // namespace regather::results
