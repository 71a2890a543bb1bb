#include "charts/chart.h"

#include <fmt/format.h>

#include "charts/gnuplot.h"
#include "charts/kinds.h"
#include "charts/lettering.h"
#include "trace/error.h"
#include "trace/file.h"
#include "trace/text.h"

namespace regather::charts {
namespace {

template <class R>
bool any(const results::Rows& rows) {
    return !rows.of<R>().empty();
}

constexpr ChartKind kinds_table[] = {
    {"traffic-by-tile", "Memory traffic by tile size", "at least 2 tile sizes", any<results::Row>,
     traffic_by_tile},
    {"traffic-by-cache", "Memory traffic by cache size", "at least 2 cache sizes", any<results::Row>,
     traffic_by_cache},
    {"cost-by-tile", "Cost of reordering by tile size", "at least 2 tile sizes", any<results::Row>,
     cost_by_tile},
    {"cost-by-bins", "Cost of reordering by number of direction bins", "at least 2 numbers of bins",
     any<results::Row>, cost_by_bins},
    {"misses-by-class", "Why lines are missed", "compulsory, capacity and conflict", any<results::Row>,
     misses_by_class},
    {"net-benefit", "Best ordering by on-chip budget",
     "at least 2 budgets, and buffer_traffic_bytes or reorder_bytes", any<results::Row>, net_benefit},
    {"best-under-budget", "Best orderings by state kept on the chip",
     "at least 2 states on the chip, and buffer_traffic_bytes or reorder_bytes", any<results::Row>,
     best_under_budget},
    {"traffic-by-frame", "Memory traffic along the camera path", "at least 2 frames", any<results::Row>,
     traffic_by_frame},
    {"traffic-by-layout", "Memory traffic by structure and layout", "at least 2 structures or layouts",
     any<results::Row>, traffic_by_layout},
    {"traffic-by-technique", "Memory traffic by sampling and cache of irradiance",
     "at least 2 strategies of sampling, or captures with and without a cache of irradiance",
     any<results::Row>, traffic_by_technique},
    {"traffic-by-depth", "Memory traffic by depth in the tree", "rows by region and tree depth",
     any<results::DetailRow>, traffic_by_depth},
    {"timeline", "Misses over the run", "rows by slice of the run", any<results::TimelineRow>, timeline},
    {"sampling-error", "Set sampling: error against run time", "rows of sampled runs",
     any<results::SamplingRow>, sampling_error},
    {"frame-traffic", "A frame's rays and searches, together and apart",
     "rows of a frame's traces, together and apart", any<results::FrameRow>, frame_traffic},
    {"error-by-time", "Error against run time", "rows of settings with total_seconds and rmse",
     any<results::ConvergenceRow>, error_by_time},
    {"error-by-render-time", "Error against render time", "rows of settings with render_seconds and rmse",
     any<results::ConvergenceRow>, error_by_render_time},
    {"time-to-error", "Run time to an error", "settings of a ladder that reach half of the mean radiance",
     any<results::ConvergenceRow>, time_to_error},
    {"efficiency", "Efficiency: 1 / (variance × run time)", "rows of settings with efficiency",
     any<results::ConvergenceRow>, efficiency},
    {"bias-by-photons", "Bias and variance by number of photons",
     "direct visualisation at 2 or more numbers of photons", any<results::ConvergenceRow>, bias_by_photons},
    {"bias-by-k", "Bias and variance by photons of a gather",
     "direct visualisation at 2 or more k with the photons held", any<results::ConvergenceRow>, bias_by_k},
    {"computation", "Floating-point operations by parameter", "rows of the computation by parameter",
     any<results::ComputationRow>, computation},
    {"stability", "Stiff and extreme cases: error and what is allowed", "rows of the stability study",
     any<results::StabilityRow>, stability},
};

std::string xml_text(std::string_view text) {
    std::string out;
    for (const char c : drawable(text))
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
    throw trace::UsageError(
        fmt::format("chart {} is not known, expected one of {}", trace::in_quotes(name), names));
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

std::vector<const ChartKind*> wanted_kinds(const results::Rows& rows, std::span<const std::string> names) {
    std::vector<const ChartKind*> out;
    for (const std::string& name : names) out.push_back(&chart_kind(name));
    if (!names.empty()) return out;
    for (const ChartKind& kind : kinds_table)
        if (kind.has_rows(rows)) out.push_back(&kind);
    return out;
}

std::array<std::filesystem::path, 2> files_of(const std::filesystem::path& folder, const ChartKind& kind) {
    return {folder / fmt::format("{}.svg", kind.name), folder / fmt::format("{}.png", kind.name)};
}

std::vector<Drawn> write_charts(const std::filesystem::path& folder, const results::Rows& rows,
                                std::span<const std::string> kinds, const ChartOptions& options) {
    std::vector<Drawn> out;
    for (const ChartKind* kind : wanted_kinds(rows, kinds)) {
        const Chart chart = kind->compose(*kind, rows, options);
        Drawn& drawn = out.emplace_back(Drawn{kind->name, {}, chart.skipped});
        if (!chart.skipped.empty()) continue;
        const auto [svg, png] = files_of(folder, *kind);
        trace::write_whole(svg, render(chart, Picture::svg));
        trace::write_whole(png, render(chart, Picture::png));
        drawn.files = {svg, png};
    }
    return out;
}

}  // namespace regather::charts
