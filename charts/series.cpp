#include "charts/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "results/parameters.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::charts {
namespace {

constexpr bool tiles = true;
/// The look of an ordering is the same in every chart. Colours: Okabe & Ito's colour-blind-safe palette and
/// shades that differ from it in lightness; each has its own point marker too, for prints in grey.
struct Style {
    std::string_view ordering, label, colour;
    int marker;             // gnuplot's point type
    bool can_tile = false;  // without a tile it runs over the whole image, and says so
};
constexpr Style known[] = {
    {"random", "Random", "#999999", 3},
    {"naive", "Naive", "#000000", 2},
    {"tiled", "Tiled", "#8c564b", 8},
    {"direction-binned", "Direction bins", "#e69f00", 5},
    {"direction-binned+hashed", "Direction bins + hashed", "#d55e00", 13},
    {"hashed", "Hashed", "#cc79a7", 15},
    {"strata", "Strata", "#44aa99", 12},
    {"strata+hashed", "Strata + hashed", "#332288", 14},
    {"swizzle", "Swizzle", "#56b4e9", 11, tiles},
    {"morton", "Morton", "#009e73", 9, tiles},
    {"hilbert", "Hilbert", "#0072b2", 7, tiles},
    {"kd-leaf", "kd-tree leaf", "#882255", 4, tiles},
    {"bvh-leaf", "BVH leaf", "#b0a000", 6, tiles},
    // Of rays, which have no strata: their marks.
    {"origin-direction", "Origin + direction", "#aa4499", 12, tiles},
    {"origin-guess", "Origin + guessed end", "#117733", 14, tiles},
    {"origin-end", "Origin + end", "#661100", 10, tiles},
};
constexpr std::string_view spare_colours[] = {"#6699cc", "#999933", "#ddcc77", "#888888"};

/// What, besides ordering, tile and bins, tells two curves apart.
constexpr std::size_t trait_count = 9;
using Traits = std::array<std::string, trait_count>;

Traits traits_of(const results::Row& row, bool merge_frames) {
    return {row.scene,
            row.frame && !merge_frames ? fmt::format("frame {}", *row.frame) : "",
            row.structure,
            row.layout,
            row.policy,
            row.set_sampling.value_or(1) > 1 ? fmt::format("1/{} of the sets", *row.set_sampling) : "",
            row.sampling,
            row.irradiance_cache,
            results::other_parameters(row)};
}

struct Group {
    std::string ordering;
    bool tiled, binned;
    Traits traits;
    std::vector<const results::Row*> rows;
    std::vector<std::vector<const results::Row*>> frames = {};
};

bool fits(const results::Row& row, Along along, const results::Geometry& cache) {
    const auto geometry = results::geometry_of(row);
    if (!geometry || !row.traffic_bytes || (along == Along::bins && !row.bins)) return false;
    if (row.tile == std::uint64_t{0} || row.bins == std::uint64_t{0}) return false;  // no place on a log axis
    results::Geometry wanted = cache;
    if (along == Along::cache) wanted.cache_bytes = geometry->cache_bytes;
    return *geometry == wanted;
}

std::vector<Group> groups_of(std::span<const results::Row> rows, Along along, const results::Geometry& cache,
                             bool merge_frames) {
    std::vector<Group> groups;
    for (const results::Row& row : rows) {
        if (!fits(row, along, cache)) continue;
        const Traits traits = traits_of(row, merge_frames);
        const bool tiled = row.tile.has_value(), binned = row.bins.has_value();
        auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
            return g.ordering == row.ordering && g.tiled == tiled && g.binned == binned && g.traits == traits;
        });
        if (group == groups.end())
            group = groups.insert(group, {row.ordering, tiled, binned, traits, {}, {}});
        group->rows.push_back(&row);
    }
    return groups;
}

/// Keeps the rows whose `field` is the nearest to `wanted` that there is.
void hold(std::vector<const results::Row*>& rows, results::Count results::Row::*field, std::uint64_t wanted) {
    const auto distance = [&](std::uint64_t value) {
        return std::abs(std::log2(static_cast<double>(value)) - std::log2(static_cast<double>(wanted)));
    };
    std::uint64_t best = *(rows.front()->*field);
    for (const results::Row* row : rows) {
        const std::uint64_t value = *(row->*field);
        if (distance(value) < distance(best) || (distance(value) == distance(best) && value < best))
            best = value;
    }
    std::erase_if(rows, [&](const results::Row* row) { return *(row->*field) != best; });
}

/// Sorted along the axis, one row a place; the rows of all frames beside it.
void settle(Group& group, Along along, bool flat) {
    auto& rows = group.rows;
    const auto place = [&](const results::Row* row) { return flat ? 0 : axis_value(*row, along); };
    std::stable_sort(rows.begin(), rows.end(), [&](auto a, auto b) {
        return place(a) != place(b) ? place(a) < place(b) : a->frame < b->frame;
    });
    for (std::size_t i = 1; i < rows.size();) {
        const results::Row &a = *rows[i - 1], &b = *rows[i];
        if (place(&a) != place(&b) || a.frame != b.frame) {
            ++i;
            continue;
        }
        if (a.traffic_bytes != b.traffic_bytes || a.key_ops != b.key_ops ||
            a.buffered_bytes != b.buffered_bytes)
            throw trace::DataError(fmt::format(
                "rows of {} contradict each other: the same parameters and cache with {} and with {} "
                "bytes of "
                "traffic, expected one measurement each",
                trace::in_quotes(b.parameters.empty() ? b.ordering : b.parameters), *a.traffic_bytes,
                *b.traffic_bytes));
        rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(i));
    }
    std::vector<const results::Row*> places;
    for (const results::Row* row : rows) {
        if (places.empty() || place(places.back()) != place(row)) {
            places.push_back(row);
            group.frames.emplace_back();
        }
        group.frames.back().push_back(row);
    }
    rows = places;
}

Curve look_of(const Group& group, const std::vector<Curve>& before, std::span<const std::string> strangers,
              bool flat) {
    Curve curve;
    const auto style = std::find_if(std::begin(known), std::end(known),
                                    [&](const Style& s) { return s.ordering == group.ordering; });
    if (style != std::end(known)) {
        curve.label = style->label;
        curve.colour = style->colour;
        curve.marker = style->marker;
    } else {
        const auto nth = static_cast<std::size_t>(
            std::find(strangers.begin(), strangers.end(), group.ordering) - strangers.begin());
        curve.label = group.ordering;
        curve.colour = spare_colours[nth % std::size(spare_colours)];
        curve.marker = 10 + static_cast<int>(nth % 6);
    }
    for (const Curve& other : before)
        curve.variant += other.rows.front()->ordering == group.ordering && other.flat == flat;
    curve.flat = flat;
    return curve;
}

/// "Direction bins + hashed" -> "Direction bins 16×16 + hashed", "Strata" -> "Strata 10×10"; where a label
/// speaks of neither, at its end.
void name_bins(std::string& label, std::uint64_t bins) {
    for (const std::string_view word : {"bins", "Strata"})
        if (const auto at = label.find(word); at != label.npos) {
            label.insert(at + word.size(), fmt::format(" {0}×{0}", bins));
            return;
        }
    label += fmt::format(", {0}×{0} bins", bins);
}

}  // namespace

double axis_value(const results::Row& row, Along along) {
    const results::Count& value = along == Along::tile   ? row.tile
                                  : along == Along::bins ? row.bins
                                                         : row.cache_bytes;
    return static_cast<double>(*value);
}

std::vector<Curve> curves(std::span<const results::Row> rows, Along along, const Slice& slice) {
    std::vector<Group> groups = groups_of(rows, along, slice.cache, slice.merge_frames);
    std::array<bool, trait_count> differs{};
    std::vector<std::string> strangers;
    for (const Group& group : groups) {
        // A parameter tells curves apart only within its ordering; scene, frame, layout ... within the chart.
        for (std::size_t t = 0; t + 1 < trait_count; ++t)
            differs[t] |= group.traits[t] != groups[0].traits[t];
        const bool is_known = std::any_of(std::begin(known), std::end(known),
                                          [&](const Style& s) { return s.ordering == group.ordering; });
        if (!is_known && std::find(strangers.begin(), strangers.end(), group.ordering) == strangers.end())
            strangers.push_back(group.ordering);
    }
    // What another trait tells already is told by the picture's caption alone: here the layout where each
    // structure has one of its own.
    constexpr std::size_t structure = 2, layout = 3;
    std::map<std::string, std::set<std::string>> layouts;
    for (const Group& group : groups) layouts[group.traits[structure]].insert(group.traits[layout]);
    if (layouts.size() > 1 &&
        std::all_of(layouts.begin(), layouts.end(), [](const auto& of) { return of.second.size() == 1; }))
        differs[layout] = false;
    // Of a spec the name does, where its parameters are the same everywhere.
    constexpr std::size_t sampling = 6, irradiance_cache = 7;
    for (const std::size_t spec : {sampling, irradiance_cache}) {
        std::map<std::string, std::set<std::string>> texts;
        for (const Group& group : groups)
            texts[results::spec_name(group.traits[spec])].insert(group.traits[spec]);
        for (Group& group : groups)
            if (std::string name = results::spec_name(group.traits[spec]); texts[name].size() == 1)
                group.traits[spec] = std::move(name);
    }
    std::vector<Curve> out;
    for (Group& group : groups) {
        if (group.tiled && along != Along::tile) hold(group.rows, &results::Row::tile, slice.tile);
        if (group.binned && along != Along::bins) hold(group.rows, &results::Row::bins, slice.bins);
        Curve curve = look_of(group, out, strangers, along == Along::tile && !group.tiled);
        settle(group, along, curve.flat);
        curve.rows = group.rows;
        if (slice.merge_frames) curve.frames = group.frames;

        const results::Row& row = *curve.rows.front();
        const auto can_tile = std::any_of(std::begin(known), std::end(known), [&](const Style& s) {
            return s.ordering == group.ordering && s.can_tile;
        });
        if (group.tiled && along != Along::tile) curve.label += fmt::format(", {0}×{0} tiles", *row.tile);
        if (!group.tiled && can_tile) curve.label += ", whole image";
        if (group.binned && along != Along::bins) name_bins(curve.label, *row.bins);
        const bool parameters_differ = std::any_of(groups.begin(), groups.end(), [&](const Group& other) {
            return other.ordering == group.ordering && other.tiled == group.tiled &&
                   other.binned == group.binned && other.traits.back() != group.traits.back();
        });
        for (std::size_t t = 0; t < trait_count; ++t) {
            const bool told = t + 1 < trait_count ? differs[t] : parameters_differ;
            if (told && !group.traits[t].empty()) curve.label += ", " + group.traits[t];
        }
        out.push_back(std::move(curve));
    }
    return out;
}

Line line_of(const Curve& curve) {
    Line line;
    line.label = curve.label;
    line.colour = curve.colour;
    line.marker = curve.marker;
    line.variant = curve.variant;
    return line;
}

Line line_of(const std::string& ordering, std::span<const std::string> all) {
    std::vector<results::Row> names;
    for (const std::string& name : all) {
        results::Row& row = names.emplace_back();
        row.ordering = name;
        row.cache_bytes = row.line_bytes = row.ways = row.tile = 1;
        row.traffic_bytes = 0;
    }
    for (const Curve& curve : curves(names, Along::tile, {{1, 1, 1}, 1, 1}))
        if (curve.rows.front()->ordering == ordering) return line_of(curve);
    return {};
}

}  // namespace regather::charts
