#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "charts/caption.h"
#include "charts/kinds.h"
#include "charts/series.h"
#include "results/budget.h"

namespace regather::charts {
namespace {

using results::Front, results::FrontStep;

/// What the axis shows: from the first to the last of results::budgets().
struct Ends {
    double low, high;
};

/// Light for a small cache, dark for a large one.
std::string grey(std::size_t place, std::size_t count) {
    const double share = count < 2 ? 1 : static_cast<double>(place) / static_cast<double>(count - 1);
    const auto level = static_cast<unsigned>(std::lround(0xb8 - share * (0xb8 - 0x10)));
    return fmt::format("#{0:02x}{0:02x}{0:02x}", level);
}

/// The steps that the axis shows; those below its left end are one, at that end.
std::vector<FrontStep> shown_steps(const Front& front, const Ends& ends) {
    std::vector<FrontStep> out;
    for (const FrontStep& step : front.steps) {
        if (static_cast<double>(step.state_bytes) > ends.high || step.net_bytes == 0) continue;
        if (static_cast<double>(step.state_bytes) <= ends.low) out.clear();
        out.push_back(step);
    }
    return out;
}

/// A line of steps for each cache, and on them the orderings that take them.
Panel panel_of(std::span<const Front> fronts, const Ends& ends, const results::ByteUnit& unit,
               std::span<const std::string> orderings) {
    Panel panel;
    panel.up.label = fmt::format("net traffic [{}]", unit.name);
    panel.height = 190;
    std::vector<Line> winners;
    for (const std::string& ordering : orderings) {
        Line& line = winners.emplace_back(line_of(ordering, orderings));
        line.form = Line::Form::points;
    }
    for (std::size_t f = 0; f < fronts.size(); ++f) {
        Line line;
        line.label = fmt::format("{} cache", results::binary_bytes(fronts[f].cache_bytes));
        line.colour = grey(f, fronts.size());
        line.variant = static_cast<int>(f);
        line.form = Line::Form::plain;
        for (const FrontStep& step : shown_steps(fronts[f], ends)) {
            const Point at{std::max(static_cast<double>(step.state_bytes), ends.low),
                           static_cast<double>(step.net_bytes) / unit.bytes};
            if (!line.points.empty()) line.points.push_back({at.x, line.points.back().y});
            line.points.push_back(at);
            const auto winner = std::find(orderings.begin(), orderings.end(), step.row->ordering);
            winners[static_cast<std::size_t>(winner - orderings.begin())].points.push_back(at);
        }
        if (line.points.empty()) continue;
        line.points.push_back({ends.high, line.points.back().y});
        panel.lines.push_back(std::move(line));
    }
    std::erase_if(winners, [](const Line& line) { return line.points.empty(); });
    panel.lines.insert(panel.lines.end(), winners.begin(), winners.end());
    return panel;
}

}  // namespace

Chart best_under_budget(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options) {
    const std::vector<results::Row> known = results::rows_of_shape(rows.of<results::Row>(), options.cache);
    if (known.empty())
        return skip(options.cache ? fmt::format("no row has {}", results::shape_text(*options.cache))
                                  : fmt::format("needs {}", kind.needs));
    if (!results::of_one_setting(known))
        return skip("needs rows of one scene, frame, structure, layout and policy");
    const std::vector<std::uint64_t> budgets = results::budgets();
    const Ends ends{static_cast<double>(budgets.front()), static_cast<double>(budgets.back())};
    const std::vector<Front> kept = results::fronts(known, results::Buffers::on_chip),
                             any = results::fronts(known, results::Buffers::anywhere);

    std::vector<std::string> orderings;
    std::vector<double> nets;
    bool steps = false;
    for (const std::vector<Front>* all : {&kept, &any})
        for (const Front& front : *all) {
            const std::vector<FrontStep> shown = shown_steps(front, ends);
            steps |= shown.size() > 1;
            for (const FrontStep& step : shown) {
                nets.push_back(static_cast<double>(step.net_bytes));
                if (std::find(orderings.begin(), orderings.end(), step.row->ordering) == orderings.end())
                    orderings.push_back(step.row->ordering);
            }
        }
    if (!steps) return skip(fmt::format("needs {}; found no two that differ", kind.needs));
    const results::ByteUnit unit = results::byte_unit(*std::max_element(nets.begin(), nets.end()));
    for (double& net : nets) net /= unit.bytes;

    std::vector<Panel> panels;
    if (!kept.empty()) {
        panels.push_back(panel_of(kept, ends, unit, orderings));
        panels.back().remark = "Buffers stay on the chip";
    }
    if (std::any_of(known.begin(), known.end(),
                    [](const auto& row) { return !results::stays_on_chip(row); })) {
        panels.push_back(panel_of(any, ends, unit, orderings));
        panels.back().remark = "Buffers may go through memory, which is counted";
    }
    for (Panel& panel : panels) panel.up.scale = log_scale(nets, plain_number);

    Scale across{true, ends.low / 1.3, ends.high * 1.3, {}};
    for (const std::uint64_t budget : budgets)
        across.ticks.emplace_back(static_cast<double>(budget), budget < 1 << 20
                                                                   ? fmt::format("{}K", budget >> 10)
                                                                   : fmt::format("{}M", budget >> 20));
    const results::Geometry cache = *results::geometry_of(known.front());
    return draw({std::string(kind.title),
                 caption(curves(known, Along::cache, {cache, options.tile, options.bins}),
                         results::shape_text(cache)),
                 {"state kept on the chip, beside the cache [bytes]", across},
                 std::move(panels)});
}

}  // namespace regather::charts
