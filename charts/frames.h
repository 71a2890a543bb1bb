// charts/frames.h -- how traffic varies along a camera path.
#pragma once
#include "charts/chart.h"

namespace regather::charts {

Chart traffic_by_frame(const ChartKind& kind, const Rows& rows, const ChartOptions& options);

}  // namespace regather::charts
