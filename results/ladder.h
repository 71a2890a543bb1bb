// results/ladder.h -- settings of the renderer along which one thing is varied: what they cost and how far
// off they are.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "results/convergence_row.h"
#include "results/table.h"

namespace regather::results {

/// The settings of one ladder of one picture against one reference, by rising total seconds. Rows must
/// outlive it.
struct Ladder {
    std::string label;  ///< "photons"; with scene and size where rows of several are given.
    std::vector<const ConvergenceRow*> rows;
};

/// In the order of the ladders' first appearance. Rows without total_seconds above 0 or rmse are left out.
std::vector<Ladder> ladders(std::span<const ConvergenceRow> rows);

/// Exponent of the power law y = c x^p through points above 0, by least squares of the logarithms; nothing
/// for fewer than three points or a single x.
std::optional<double> fitted_slope(std::span<const double> x, std::span<const double> y);

/// Seconds at which the ladder reaches `error` [W / (m^2 sr)]: between two settings on a straight line of the
/// logarithms. Nothing when no setting, or only one flagged below_reference, is as good; below 0: the
/// quickest setting is good enough and the seconds are at most that much.
std::optional<double> seconds_to(const Ladder& ladder, double error);

/// How many gather rays `cosine` needs for each of a strategy's, for the same error of what gather rays
/// bring.
struct EqualError {
    const ConvergenceRow* row = nullptr;                  ///< Of the strategy.
    double rays = 0;                                      ///< Variance of cosine over that of the strategy.
    std::optional<std::pair<double, double>> interval{};  ///< 95 %; from three images on.
};

/// Of each row with a photon_seed (its images differ by gather rays alone) beside which there is one of the
/// strategy cosine, all else being equal; in the order of rows, which must outlive it. Variance falls with
/// the number of rays at least as 1 / N, so where strata make it fall faster the rays are fewer. The interval
/// takes the logarithm of each variance to be normal with the jackknife's standard error, and both to be
/// independent.
std::vector<EqualError> equal_errors(std::span<const ConvergenceRow> rows);
/// A line for each; no lines without rows.
Table equal_error_table(std::span<const ConvergenceRow> rows);

/// `value` over the mean radiance of the row's reference [%]; `value` itself where that is not known.
double percent_of_mean(const ConvergenceRow& row, double value);

/// A line a setting; no lines without rows.
Table convergence_table(std::span<const ConvergenceRow> rows);
/// Seconds to 50, 20, ... 1 % of the mean radiance, those that some ladder crosses; a line a ladder.
Table time_table(std::span<const ConvergenceRow> rows);

}  // namespace regather::results
