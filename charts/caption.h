// charts/caption.h -- the line under a chart's title: what is the same for all that is drawn.
#pragma once
#include <span>
#include <string>

#include "charts/series.h"

namespace regather::charts {

/// `cache`: its shape, or empty where the cache does not matter.
std::string caption(std::span<const Curve> curves, const std::string& cache);

}  // namespace regather::charts
