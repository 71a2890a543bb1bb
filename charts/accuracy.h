// charts/accuracy.h -- error of set sampling against run time: by ordering and rate, as a table and as a
// chart.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "charts/chart.h"

namespace regather::charts {

/// All runs of one ordering at one rate, over seeds and caches.
struct Accuracy {
    const results::SamplingRow* first = nullptr;  ///< For the ordering's name.
    std::uint64_t set_sampling = 1;
    std::size_t runs = 0;
    double rms_error = 0,
           worst_error = 0;  ///< Of misses, relative to the exact ones; rows without any are left out.
    double seconds = 0;      ///< Median.
    std::optional<double> speed_up;          ///< Median of the exact runs' seconds, over that.
    std::size_t intervals = 0, covered = 0;  ///< 95 % intervals, and how many hold the truth.
};

/// In the order of the orderings' first appearance, then by falling rate. Rows without a rate, misses, exact
/// misses or seconds are left out. Rows must outlive the result.
std::vector<Accuracy> accuracies(std::span<const results::SamplingRow> rows);

/// For a terminal, at most 100 characters wide. Empty without rows.
std::string accuracy_table(std::span<const results::SamplingRow> rows);

Chart sampling_error(const ChartKind& kind, const Rows& rows, const ChartOptions& options);

}  // namespace regather::charts
