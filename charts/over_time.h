// charts/over_time.h -- settings of the renderer over the seconds that they take: final gathers above, direct
// visualisation below, on the same scales.
#pragma once
#include <optional>
#include <string>

#include "charts/chart.h"

namespace regather::charts {

struct OverTime {
    using Value = std::optional<double> (*)(const results::ConvergenceRow&);
    Value seconds, height;
    std::string up, across;            ///< Labels of the axes.
    bool with_slopes, with_reference;  ///< Fitted slopes in the legend; the reference's own error as a line.
};
Chart over_time(const ChartKind& kind, const results::Rows& rows, const OverTime& what);

std::optional<double> total_seconds(const results::ConvergenceRow& row);
std::optional<double> relative_rmse(const results::ConvergenceRow& row);  ///< [% of the mean radiance]

}  // namespace regather::charts
