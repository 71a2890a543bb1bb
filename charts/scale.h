// charts/scale.h -- axes: their ends, and where a number stands on them.
#pragma once
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace regather::charts {

struct Scale {
    bool log = false;
    double low = 0, high = 1;
    std::vector<std::pair<double, std::string>> ticks = {};

    /// From 0 at `low` to 1 at `high`.
    double share(double value) const;
    /// What stands there.
    double at(double share) const;
};

/// Encloses `values` with a margin; ticks at 1, 2, 5 or whole decades. Values must be above 0.
Scale log_scale(std::span<const double> values, std::string (*label)(double));
/// From 0 to a round number at or above `high`; four to six ticks.
Scale linear_scale(double high, std::string (*label)(double));
/// 0 to 100 in steps of 20.
Scale percent_scale();

/// Round values from at most `low` to at least `high`: 1, 2, 5 a decade, or whole decades when they are many.
std::vector<double> log_ticks(double low, double high);

std::string plain_number(double value);  ///< "0.002", "36"
std::string byte_number(double bytes);   ///< "100 MB"
std::string kib_number(double bytes);    ///< "0.5", "128": where the axis says KiB

}  // namespace regather::charts
