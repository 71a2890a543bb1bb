#include "charts/kinds.h"

#include <fmt/format.h>

#include <algorithm>

#include "charts/caption.h"
#include "charts/envelope.h"
#include "charts/series.h"
#include "results/budget.h"

namespace regather::charts {
namespace {

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
    const std::vector<results::Row> shown = results::rows_of_shape(rows.of<results::Row>(), options.cache);
    if (shown.empty())
        return skip(options.cache ? fmt::format("no row has {}", results::shape_text(*options.cache))
                                  : fmt::format("needs {}", kind.needs));
    if (!results::of_one_setting(shown))
        return skip("needs rows of one scene, frame, structure, layout and policy");
    const results::Geometry cache = *results::geometry_of(shown.front());
    const std::string shape = results::shape_text(cache);
    const std::vector<Envelope> all = envelopes(shown);
    std::vector<std::string> orderings;
    for (const Envelope& envelope : all) orderings.push_back(envelope.ordering);

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
        const Line look = line_of(all[reign[r].winner].ordering, orderings);
        const double to = r + 1 < reign.size() ? static_cast<double>(reign[r + 1].from_bytes) : scale.high;
        band.boxes.push_back({static_cast<double>(reign[r].from_bytes), to, 0, 1, "", look.colour, look.label,
                              is_dark(look.colour) ? "#ffffff" : "#000000"});
    }

    Panel panel;
    panel.up.label = fmt::format("net traffic [{}]", unit.name);
    panel.height = 250;
    panel.up.scale = log_scale(nets, plain_number);
    for (const Envelope& envelope : all) {
        Line line = line_of(envelope.ordering, orderings);
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
