// charts/sweep.h -- measurements along an axis: what is drawn of them, one panel a measure.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "charts/chart.h"
#include "charts/series.h"

namespace regather::charts {

/// The curves of a chart, or why there are none. A chart along an axis needs two places on it.
struct Sweep {
    Along along;
    std::vector<Curve> curves = {};
    results::Geometry cache = {};
    std::string skipped = {};
};
Sweep sweep(const ChartKind& kind, std::span<const results::Row> rows, Along along,
            const ChartOptions& options);

/// Of rows of several frames the median, with a bar from the least to the most.
struct Measure {
    std::string label;  ///< Of the vertical axis, with its unit.
    std::function<std::optional<double>(const results::Row&)> of;
    std::string (*tick_label)(double);
    std::string nothing;               ///< Before the names of curves that are all 0.
    std::optional<double> floor = {};  ///< A thin level line ...
    std::string floor_label = {};      ///< ... and what it is.
};

/// The legend lists curves from top to bottom of the first panel. Nothing when no panel has anything above 0.
std::optional<Chart> draw(const Sweep& sweep, const std::string& title, const std::string& caption,
                          std::span<const Measure> measures);

/// What both charts of traffic and both charts of cost show.
Chart draw_traffic(const ChartKind& kind, const Sweep& sweep, const std::string& cache);
Chart draw_cost(const ChartKind& kind, const Sweep& sweep);

}  // namespace regather::charts
