// charts/timeline.h -- misses per query as a run goes on.
#pragma once
#include "charts/chart.h"

namespace regather::charts {

Chart timeline(const ChartKind& kind, const Rows& rows, const ChartOptions& options);

}  // namespace regather::charts
