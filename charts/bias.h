// charts/bias.h -- bias and standard deviation of direct visualisation beside the laws that theory expects.
#pragma once
#include <string>

#include "charts/chart.h"

namespace regather::charts {

enum class Varied { photons, k };

/// Of the ladders along which that one is varied.
Chart bias_chart(const ChartKind& kind, const results::Rows& rows, Varied varied, std::string across);

}  // namespace regather::charts
