#include "charts/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "charts/caption.h"
#include "charts/lettering.h"
#include "charts/series.h"
#include "results/parameters.h"

namespace regather::charts {
namespace {

constexpr double line_pixels = 36;  // of a structure and its layout, whose names stand above the marks
constexpr double place_width = 400;
constexpr double marks_at = 0.3, floor_from = 0.1, floor_to = 0.5;  // of a line's height

/// Marks have no lines whose dashes tell an ordering's curves apart: every second one's is hollow.
int marker_of(const Curve& curve) {
    const bool filled = curve.marker >= 5 && curve.marker % 2 == 1;  // gnuplot: one less is hollow
    return curve.marker - (filled && curve.variant % 2 == 1 ? 1 : 0);
}

/// What tells where, and of which capture, rows are: scene, frame, sampling, cache of irradiance, structure,
/// layout.
using Whereabouts = std::array<std::string, 6>;

struct Place {
    Whereabouts whereabouts;
    std::vector<results::Row> rows;
};

Whereabouts whereabouts_of(const results::Row& row) {
    return {row.scene,
            row.frame ? fmt::format("frame {}", *row.frame) : "",
            row.sampling.empty() ? "brdf" : results::spec_name(row.sampling),
            row.irradiance_cache.empty() ? "no cache" : results::spec_name(row.irradiance_cache) + " cache",
            row.structure,
            row.layout};
}

constexpr std::size_t first_of_technique = 2, first_of_layout = 4;  // of Whereabouts

/// Whether places differ in one of the traits `from` up to `to`.
bool differ(const std::vector<Place>& places, std::size_t from, std::size_t to) {
    return std::any_of(places.begin(), places.end(), [&](const Place& place) {
        return !std::equal(place.whereabouts.begin() + static_cast<std::ptrdiff_t>(from),
                           place.whereabouts.begin() + static_cast<std::ptrdiff_t>(to),
                           places.front().whereabouts.begin() + static_cast<std::ptrdiff_t>(from));
    });
}

/// What differs among the places; of structure and layout both.
std::string name_of(const Place& place, const std::vector<Place>& all) {
    std::vector<std::string> parts;
    for (std::size_t t = 0; t < place.whereabouts.size(); ++t) {
        const bool of_layout = t >= first_of_layout;
        if (differ(all, of_layout ? first_of_layout : t, of_layout ? place.whereabouts.size() : t + 1))
            parts.push_back(place.whereabouts[t]);
    }
    return results::joined(parts, ", ");
}

/// In the order of the rows' first appearance.
std::vector<Place> places_of(std::span<const results::Row> rows, const results::Geometry& cache) {
    std::vector<Place> places;
    for (const results::Row& row : rows) {
        if (results::geometry_of(row) != cache || row.traffic_bytes.value_or(0) == 0) continue;
        auto place = std::find_if(places.begin(), places.end(),
                                  [&](const Place& p) { return p.whereabouts == whereabouts_of(row); });
        if (place == places.end()) place = places.insert(place, {whereabouts_of(row), {}});
        place->rows.push_back(row);
    }
    return places;
}

/// Where the traits `from` up to `to` differ: a line a place.
Chart traffic_by_place(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options,
                       std::size_t from, std::size_t to) {
    const std::vector<results::Row>& all = rows.of<results::Row>();
    const auto common = results::commonest_geometry(all);
    if (!common) return skip("no row has cache_bytes, line_bytes and ways");
    const results::Geometry cache = options.cache.value_or(*common);
    const std::vector<Place> places = places_of(all, cache);
    if (!differ(places, from, to)) return skip(fmt::format("needs {}", kind.needs));

    Panel panel;
    panel.height = line_pixels * static_cast<double>(places.size());
    panel.up.scale = {false, 0, static_cast<double>(places.size()), {}};
    panel.bare = true;
    std::vector<double> values;
    std::vector<Curve> every;
    std::set<std::string> in_legend;
    const auto once = [&](const std::string& label) { return in_legend.insert(label).second ? label : ""; };
    // A structure may lack some orderings: a mark is of one label everywhere.
    std::map<std::string, std::vector<std::string>> labels_of;  // by colour, as they come
    const auto tell_apart = [&](Curve& curve) {
        std::vector<std::string>& alike = labels_of[curve.colour];
        const auto place = std::find(alike.begin(), alike.end(), curve.label);
        curve.variant = static_cast<int>(place - alike.begin());
        if (place == alike.end()) alike.push_back(curve.label);
    };
    for (std::size_t p = 0; p < places.size(); ++p) {
        const double base = static_cast<double>(places.size() - 1 - p), height = base + marks_at;
        for (Curve& curve : curves(places[p].rows, Along::cache, {cache, options.tile, options.bins})) {
            const results::Row& row = *curve.rows.front();
            tell_apart(curve);
            Line line = line_of(curve);
            line.label = once(curve.label);
            line.form = Line::Form::points;
            line.marker = marker_of(curve);
            line.points = {{static_cast<double>(*row.traffic_bytes), height}};
            values.push_back(line.points[0].x);
            panel.lines.push_back(std::move(line));
            every.push_back(std::move(curve));
        }
        if (const results::Count floor = places[p].rows.front().compulsory_bytes; floor.value_or(0) > 0) {
            const auto bytes = static_cast<double>(*floor);
            values.push_back(bytes);
            panel.lines.push_back({.label = once("floor: each line fetched once"),
                                   .colour = "#777777",
                                   .width = 2.5,
                                   .form = Line::Form::plain,
                                   .points = {{bytes, base + floor_from}, {bytes, base + floor_to}}});
        }
    }
    const Scale across = log_scale(values, byte_number);
    for (std::size_t p = 0; p < places.size(); ++p)
        panel.notes.push_back({across.low, static_cast<double>(places.size() - 1 - p) + 0.72,
                               fitting(name_of(places[p], places), 11, place_width)});
    std::string text = results::geometry_text(cache);
    return draw({std::string(kind.title),
                 caption(every, "") + " · " + text.insert(text.find(','), " cache"),
                 {"traffic", across},
                 {std::move(panel)}});
}

}  // namespace

Chart traffic_by_layout(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options) {
    return traffic_by_place(kind, rows, options, first_of_layout, Whereabouts{}.size());
}

Chart traffic_by_technique(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options) {
    return traffic_by_place(kind, rows, options, first_of_technique, first_of_layout);
}

}  // namespace regather::charts
