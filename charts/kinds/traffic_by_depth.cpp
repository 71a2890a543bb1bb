#include "charts/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "charts/caption.h"
#include "charts/subject.h"

namespace regather::charts {
namespace {

/// Of all regions.
struct Level {
    double traffic = 0, used = 0;
};
std::map<double, Level> levels_of(const std::vector<const results::DetailRow*>& rows) {
    std::map<double, Level> levels;
    for (const results::DetailRow* row : rows) {
        Level& level = levels[results::number(row->tree_depth)];
        level.traffic += results::number(row->traffic_bytes);
        level.used += static_cast<double>(row->used_bytes.value_or(0));
    }
    return levels;
}

Scale depth_scale(double deepest) {
    Scale out{false, -0.5, deepest + 0.5, {}};
    const double step = deepest > 12 ? 5 : deepest > 6 ? 2 : 1;
    for (double depth = 0; depth <= deepest; depth += step)
        out.ticks.emplace_back(depth, plain_number(depth));
    return out;
}

}  // namespace

Chart traffic_by_depth(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options) {
    std::vector<const results::DetailRow*> levels;
    for (const results::DetailRow& row : rows.of<results::DetailRow>())
        if (row.tree_depth && row.traffic_bytes) levels.push_back(&row);
    if (levels.empty()) return skip(fmt::format("needs {}, with traffic_bytes", kind.needs));
    std::stable_sort(levels.begin(), levels.end(),
                     [](auto a, auto b) { return *a->tree_depth < *b->tree_depth; });
    const auto shown = subjects<results::DetailRow>(levels, options);
    if (!shown.skipped.empty()) return skip(shown.skipped);

    std::vector<double> traffics, overfetches;
    double deepest = 0;
    for (const auto& subject : shown.all)
        for (const auto& [depth, level] : levels_of(subject.rows)) {
            deepest = std::max(deepest, depth);
            if (level.traffic == 0) continue;
            traffics.push_back(level.traffic);
            if (level.used > 0) overfetches.push_back(level.traffic / level.used);
        }
    if (traffics.empty()) return skip("no traffic above 0");

    Panel traffic, overfetch;
    traffic.up.label = "traffic";
    traffic.height = 210;
    traffic.up.scale = log_scale(traffics, byte_number);
    overfetch.up.label = "fetched / used bytes";
    overfetch.height = 130;
    for (const auto& subject : shown.all) {
        Line above = line_of(subject.curve), below = above;
        for (const auto& [depth, level] : levels_of(subject.rows)) {
            if (level.traffic == 0) continue;
            above.points.push_back({depth, level.traffic});
            if (level.used > 0) below.points.push_back({depth, level.traffic / level.used});
        }
        traffic.lines.push_back(std::move(above));
        overfetch.lines.push_back(std::move(below));
    }
    std::string text = results::geometry_text(shown.cache);
    Figure figure{std::string(kind.title),
                  caption(curves_of(shown), text.insert(text.find(','), " cache")),
                  {"depth in the tree (root 0)", depth_scale(deepest)},
                  {std::move(traffic)}};
    if (!overfetches.empty()) {
        overfetch.up.scale =
            linear_scale(*std::max_element(overfetches.begin(), overfetches.end()), plain_number);
        figure.panels.push_back(std::move(overfetch));
    }
    return draw(figure);
}

}  // namespace regather::charts
