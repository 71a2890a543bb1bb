// charts/depth.h -- which levels of the tree the traffic is for, and how much of a fetched line is used
// there.
#pragma once
#include "charts/chart.h"

namespace regather::charts {

Chart traffic_by_depth(const ChartKind& kind, const Rows& rows, const ChartOptions& options);

}  // namespace regather::charts
