// charts/stability.h -- the stability study as a table for a terminal and as a chart: for each case the
// measured error beside what is allowed, and the seconds it took.
#pragma once
#include <span>
#include <string>

#include "charts/chart.h"

namespace regather::charts {

/// A header and a line a row, cases that failed with "FAILED"; then how many passed.
std::string stability_table(std::span<const results::StabilityRow> rows);

Chart stability(const ChartKind& kind, const Rows& rows, const ChartOptions& options);

}  // namespace regather::charts
