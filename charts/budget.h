// charts/budget.h -- which ordering is best for which on-chip budget: lower envelopes of net traffic, and
// who wins.
#pragma once
#include "charts/chart.h"

namespace regather::charts {

Chart net_benefit(const ChartKind& kind, const Rows& rows, const ChartOptions& options);

}  // namespace regather::charts
