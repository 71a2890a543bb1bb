// charts/sweep.h -- charts along an axis of a sweep (tile edge, cache size, direction bins), both axes log:
// after the paper's Figure 4 (section 6.3).
#pragma once
#include "charts/chart.h"

namespace regather::charts {

Chart traffic_by_tile(const ChartKind& kind, const Rows& rows, const ChartOptions& options);
Chart traffic_by_cache(const ChartKind& kind, const Rows& rows, const ChartOptions& options);
Chart cost_by_tile(const ChartKind& kind, const Rows& rows, const ChartOptions& options);
Chart cost_by_bins(const ChartKind& kind, const Rows& rows, const ChartOptions& options);

}  // namespace regather::charts
