// charts/kinds.h -- one function a chart, in kinds/ under the chart's name: rows in, a picture out. The table
// of them is in chart.cpp. Each gives Chart::skipped where the rows do not allow it.
#pragma once
#include "charts/chart.h"

namespace regather::charts {

// Measurements along a sweep, after the paper's Figure 4 (section 6.3); both axes log.
Chart traffic_by_tile(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart traffic_by_cache(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart cost_by_tile(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart cost_by_bins(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
// Other measurements: a bar an ordering by Hill's classes; the least net traffic for a budget of cache and
// state, and for one of state beside each cache; along a camera path; a line a structure and layout.
Chart misses_by_class(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart net_benefit(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart best_under_budget(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart traffic_by_frame(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart traffic_by_layout(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart traffic_by_technique(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
// Rows by region and depth, by slice of the run, of sampled runs.
Chart traffic_by_depth(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart timeline(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart sampling_error(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
// Traces of one frame, together and apart.
Chart frame_traffic(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
// Settings of the renderer.
Chart error_by_time(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart error_by_render_time(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart time_to_error(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart efficiency(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart bias_by_photons(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
Chart bias_by_k(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
// Estimates of floating-point operations: how much each parameter moves the total.
Chart computation(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);
// Cases of the stability study.
Chart stability(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options);

}  // namespace regather::charts
