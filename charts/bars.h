// charts/bars.h -- why lines are missed: a bar an ordering, split by the shares of Hill's three classes of
// misses.
#pragma once
#include "charts/chart.h"

namespace regather::charts {

Chart misses_by_class(const ChartKind& kind, const Rows& rows, const ChartOptions& options);

}  // namespace regather::charts
