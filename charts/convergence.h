// charts/convergence.h -- error against run time, bias and variance: tables for a terminal, and charts.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "charts/chart.h"

namespace regather::charts {

/// The settings of one ladder of one picture against one reference, by rising total seconds. Rows must
/// outlive it.
struct Ladder {
    std::string label;  ///< "photons"; with scene and size where rows of several are given.
    std::vector<const results::ConvergenceRow*> rows;
};

/// In the order of the ladders' first appearance. Rows without total_seconds above 0 or rmse are left out.
std::vector<Ladder> ladders(std::span<const results::ConvergenceRow> rows);

/// Exponent of the power law y = c x^p through points above 0, by least squares of the logarithms; nothing
/// for fewer than three points or a single x.
std::optional<double> fitted_slope(std::span<const double> x, std::span<const double> y);

/// Seconds at which the ladder reaches `error` [W / (m^2 sr)]: between two settings on a straight line of the
/// logarithms. Nothing when no setting, or only one flagged below_reference, is as good; below 0: the
/// quickest setting is good enough and the seconds are at most that much.
std::optional<double> seconds_to(const Ladder& ladder, double error);

/// For a terminal, at most 100 characters wide: a line a setting; empty without rows.
std::string convergence_table(std::span<const results::ConvergenceRow> rows);
/// Time to 50, 20, ... 1 % of the mean radiance, those that some ladder crosses.
std::string time_table(std::span<const results::ConvergenceRow> rows);

Chart error_by_time(const ChartKind& kind, const Rows& rows, const ChartOptions& options);
Chart error_by_render_time(const ChartKind& kind, const Rows& rows, const ChartOptions& options);
Chart efficiency(const ChartKind& kind, const Rows& rows, const ChartOptions& options);
Chart bias_by_photons(const ChartKind& kind, const Rows& rows, const ChartOptions& options);
Chart bias_by_k(const ChartKind& kind, const Rows& rows, const ChartOptions& options);

}  // namespace regather::charts
