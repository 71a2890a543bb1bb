// study/chi_squared.h -- Pearson's chi-squared test of counts against expected ones.
#pragma once
#include <span>

namespace regather::study {

/// Chance of a chi-squared of at least this with so many degrees of freedom.
double chi_squared_tail(double chi_squared, double degrees);

/// p-value of `observed`; cells that expect fewer than 5 are put together. Both sum to the same total. 0 for
/// a count where none is expected.
double chi_squared_p(std::span<const double> observed, std::span<const double> expected);

/// The p-value under which one of `tests` tests has failed when all of them together may fail by chance with
/// probability `significance` (Sidak 1967).
double sidak(double significance, int tests);

}  // namespace regather::study
