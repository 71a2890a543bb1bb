#include "charts/kinds.h"

#include <fmt/format.h>

#include <array>

#include "charts/caption.h"
#include "charts/lettering.h"
#include "charts/series.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::charts {
namespace {

struct Class {
    const char* label;
    results::Count results::Row::*field;
    const char *colour, *text_colour;
};
constexpr Class classes[] = {
    {"compulsory: first touch", &results::Row::compulsory, "#c8c8c8", "#000000"},
    {"capacity: a larger cache would hit", &results::Row::capacity, "#0072b2", "#ffffff"},
    {"conflict: full associativity would hit", &results::Row::conflict, "#e69f00", "#000000"},
};
constexpr double line_pixels = 38;  // a bar's name stands above it
constexpr double label_width = 290;

bool classed(const results::Row& row) {
    return row.compulsory && row.capacity && row.conflict && row.misses;
}

/// The sum of the classes. Where all sets were simulated it must be the misses.
double sum_of(const results::Row& row) {
    const std::uint64_t sum = *row.compulsory + *row.capacity + *row.conflict;
    if (row.set_sampling.value_or(1) == 1 && sum != *row.misses)
        throw trace::DataError(fmt::format(
            "row of {}: misses: found {}, expected {}, the sum of compulsory, capacity and conflict",
            trace::in_quotes(row.parameters.empty() ? row.ordering : row.parameters), *row.misses, sum));
    return static_cast<double>(sum);
}

}  // namespace

Chart misses_by_class(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options) {
    std::vector<results::Row> fitting;
    for (const results::Row& row : rows.of<results::Row>())
        if (classed(row)) fitting.push_back(row);
    if (fitting.empty()) return skip(fmt::format("no row has {}", kind.needs));
    const auto common = results::commonest_geometry(fitting);
    if (!common) return skip("no row has cache_bytes, line_bytes and ways");
    const results::Geometry cache = options.cache.value_or(*common);
    std::erase_if(fitting, [&](const results::Row& row) { return results::geometry_of(row) != cache; });
    const auto shown = curves(fitting, Along::cache, {cache, options.tile, options.bins});
    if (shown.empty()) return skip(fmt::format("no row has the cache {}", results::geometry_text(cache)));

    Panel panel;
    panel.height = line_pixels * static_cast<double>(shown.size());
    panel.up.scale = {false, 0, static_cast<double>(shown.size()), {}};
    panel.bare = true;
    for (std::size_t c = 0; c < shown.size(); ++c) {
        const results::Row& row = *shown[c].rows.front();
        const double sum = sum_of(row), base = static_cast<double>(shown.size() - 1 - c);
        panel.notes.push_back({0, base + 0.76, charts::fitting(shown[c].label, 11, label_width)});
        panel.notes.push_back(
            {100, base + 0.76, results::decimal_count(static_cast<double>(*row.misses)) + " misses", true});
        double from = 0;
        for (const Class& one : classes) {
            const double share = sum == 0 ? 0 : 100 * static_cast<double>(*(row.*one.field)) / sum;
            panel.boxes.push_back({from, from + share, base + 0.08, base + 0.54, one.label, one.colour,
                                   fmt::format("{:.0f} %", share), one.text_colour});
            from += share;
        }
    }
    std::string text = results::geometry_text(cache);
    return draw({std::string(kind.title),
                 caption(shown, text.insert(text.find(','), " cache")),
                 {"share of misses [%]", percent_scale()},
                 {std::move(panel)}});
}

}  // namespace regather::charts
