#include "charts/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "charts/caption.h"
#include "charts/envelope.h"
#include "charts/series.h"
#include "results/benefit.h"

namespace regather::charts {
namespace {

/// What must not differ between the rows of one picture.
auto setting(const results::Row& row) {
    return std::tie(row.scene, row.frame, row.structure, row.layout, row.policy);
}

/// The rows of the commonest (or the asked for) line size and ways: any cache size.
std::vector<results::Row> comparable(std::span<const results::Row> rows, const results::Geometry& cache) {
    std::vector<results::Row> out;
    for (const results::Row& row : rows) {
        auto geometry = results::geometry_of(row);
        if (!geometry || !results::net_traffic(row)) continue;
        geometry->cache_bytes = cache.cache_bytes;
        if (*geometry == cache) out.push_back(row);
    }
    return out;
}

/// Name, colour and marker of an ordering as in the other charts, without a tile.
Line look_of(const std::string& ordering, std::span<const Envelope> all) {
    std::vector<results::Row> names;
    for (const Envelope& envelope : all) {
        results::Row row;
        row.ordering = envelope.ordering;
        row.cache_bytes = row.line_bytes = row.ways = row.tile = 1;
        row.traffic_bytes = 0;
        names.push_back(row);
    }
    for (const Curve& curve : curves(names, Along::tile, {{1, 1, 1}, 1, 1}))
        if (curve.rows.front()->ordering == ordering) return line_of(curve);
    return {};
}

Scale budget_scale(double low, double high) {
    Scale out{true, low / 1.2, high * 1.5, {}};
    double tick = 1024;
    while (tick < out.low) tick *= 2;
    const double factor = out.high / tick > 600 ? 4 : 2;
    for (; tick <= out.high; tick *= factor) out.ticks.emplace_back(tick, kib_number(tick));
    return out;
}

bool is_dark(const std::string& colour) {
    const auto part = [&](std::size_t at) { return std::stoi(colour.substr(at, 2), nullptr, 16); };
    return 2 * part(1) + 5 * part(3) + part(5) < 8 * 140;
}

}  // namespace

Chart net_benefit(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options) {
    std::vector<results::Row> known;
    for (const results::Row& row : rows.of<results::Row>())
        if (results::geometry_of(row) && results::net_traffic(row)) known.push_back(row);
    if (known.empty()) return skip(fmt::format("needs {}", kind.needs));
    results::Geometry cache = options.cache.value_or(*results::commonest_geometry(known));
    const std::vector<results::Row> shown = comparable(known, cache);
    const std::string cache_text = results::geometry_text(cache);
    const std::string shape = cache_text.substr(cache_text.find(',') + 2);
    if (shown.empty()) return skip(fmt::format("no row has {}", shape));
    for (const results::Row& row : shown)
        if (setting(row) != setting(shown.front()))
            return skip("needs rows of one scene, frame, structure, layout and policy");
    const std::vector<Envelope> all = envelopes(shown);

    std::vector<double> budgets, nets;
    for (const Envelope& envelope : all)
        for (const Step& step : envelope.steps) {
            budgets.push_back(static_cast<double>(step.budget_bytes));
            if (step.net_bytes > 0) nets.push_back(static_cast<double>(step.net_bytes));
        }
    if (nets.empty()) return skip("no traffic above 0");
    const auto [low, high] = std::minmax_element(budgets.begin(), budgets.end());
    if (*low == *high) return skip(fmt::format("needs {}; found 1 budget with {}", kind.needs, shape));
    const Scale scale = budget_scale(*low, *high);
    const results::ByteUnit unit = results::byte_unit(*std::max_element(nets.begin(), nets.end()));
    for (double& net : nets) net /= unit.bytes;

    Panel band;
    band.up.label = "best";
    band.height = 24;
    band.bare = true;
    const std::vector<Reign> reign = reigns(all);
    for (std::size_t r = 0; r < reign.size(); ++r) {
        const Line look = look_of(all[reign[r].winner].ordering, all);
        const double to = r + 1 < reign.size() ? static_cast<double>(reign[r + 1].from_bytes) : scale.high;
        band.boxes.push_back({static_cast<double>(reign[r].from_bytes), to, 0, 1, "", look.colour, look.label,
                              is_dark(look.colour) ? "#ffffff" : "#000000"});
    }

    Panel panel;
    panel.up.label = fmt::format("net traffic [{}]", unit.name);
    panel.height = 250;
    panel.up.scale = log_scale(nets, plain_number);
    for (const Envelope& envelope : all) {
        Line line = look_of(envelope.ordering, all);
        line.form = Line::Form::steps;
        for (const Step& step : envelope.steps)
            line.points.push_back(
                {static_cast<double>(step.budget_bytes), static_cast<double>(step.net_bytes) / unit.bytes});
        line.points.push_back({scale.high, line.points.back().y});
        panel.lines.push_back(std::move(line));
    }
    std::stable_sort(panel.lines.begin(), panel.lines.end(),
                     [](const Line& a, const Line& b) { return a.points.back().y > b.points.back().y; });

    return draw({std::string(kind.title),
                 caption(curves(shown, Along::cache, {cache, options.tile, options.bins}), shape),
                 {"on-chip budget: cache and buffers [KiB]", scale},
                 {std::move(band), std::move(panel)}});
}

}  // namespace regather::charts
