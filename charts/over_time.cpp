#include "charts/over_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "charts/ladder_look.h"

namespace regather::charts {
namespace {

std::string slope_text(const std::optional<double>& slope) {
    return slope ? fmt::format(", slope {}{:.2f}", *slope < 0 ? "−" : "", std::abs(*slope)) : "";
}

Line reference_line(double error) {
    Line line;
    line.label = "error of the reference";
    line.colour = "#606060";
    line.width = 1;
    line.variant = 1;
    line.form = Line::Form::rule;
    line.points = {{0, error}};
    return line;
}

}  // namespace

std::optional<double> total_seconds(const results::ConvergenceRow& row) {
    return row.total_seconds;
}

std::optional<double> relative_rmse(const results::ConvergenceRow& row) {
    return results::percent_of_mean(row, *row.rmse);
}

Chart over_time(const ChartKind& kind, const results::Rows& rows, const OverTime& what) {
    const std::vector<results::Ladder> all = results::ladders(rows.of<results::ConvergenceRow>());
    Panel panels[2];
    panels[0].remark = "Final gathers";
    panels[1].remark = "Direct visualisation";
    std::vector<double> seconds, heights[2];
    std::set<double> floors;
    for (std::size_t l = 0; l < all.size(); ++l) {
        const results::Ladder& ladder = all[l];
        const std::size_t p = is_direct(ladder) ? 1 : 0;
        Line line = line_of(ladder, l);
        std::vector<double> x, y;
        for (const results::ConvergenceRow* row : ladder.rows) {
            const auto t = what.seconds(*row), v = what.height(*row);
            if (!t || !v || *t <= 0 || *v <= 0) continue;
            line.points.push_back({*t, *v});
            seconds.push_back(*t);
            heights[p].push_back(*v);
            if (row->reference_rmse.value_or(0) > 0)
                floors.insert(results::percent_of_mean(*row, *row->reference_rmse));
            if (row->below_reference.value_or(false)) continue;
            x.push_back(*t);
            y.push_back(*v);
        }
        if (line.points.empty()) continue;
        std::sort(line.points.begin(), line.points.end(),
                  [](const Point& a, const Point& b) { return a.x < b.x; });
        if (what.with_slopes) line.label += slope_text(results::fitted_slope(x, y));
        panels[p].lines.push_back(std::move(line));
    }
    if (seconds.empty()) return skip(fmt::format("needs {} with values above 0", kind.needs));
    Figure figure{std::string(kind.title), caption(all), {what.across, log_scale(seconds, plain_number)}};
    std::vector<double> both;
    for (Panel& panel : panels)
        both.insert(both.end(), heights[&panel - panels].begin(), heights[&panel - panels].end());
    if (what.with_reference && floors.size() == 1) both.push_back(*floors.begin());
    for (std::size_t p = 0; p < 2; ++p) {
        Panel& panel = panels[p];
        if (panel.lines.empty()) continue;
        panel.up.label = what.up;
        panel.height = heights[1 - p].empty() ? 270 : 190;
        panel.up.scale = log_scale(both, plain_number);  // the same for both, so that heights may be compared
        if (what.with_reference && floors.size() == 1) panel.lines.push_back(reference_line(*floors.begin()));
        figure.panels.push_back(std::move(panel));
    }
    return draw(figure);
}

}  // namespace regather::charts
