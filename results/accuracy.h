// results/accuracy.h -- error of set sampling against run time, by ordering and rate.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "results/sampling_row.h"
#include "results/table.h"

namespace regather::results {

/// All runs of one ordering at one rate, over seeds and caches.
struct Accuracy {
    const SamplingRow* first = nullptr;  ///< For the ordering's name.
    std::uint64_t set_sampling = 1;
    std::size_t runs = 0;
    double rms_error = 0,
           worst_error = 0;  ///< Of misses, relative to the exact ones; rows without any are left out.
    double seconds = 0;      ///< Median.
    std::optional<double> speed_up;          ///< Median of the exact runs' seconds, over that.
    std::size_t intervals = 0, covered = 0;  ///< 95 % intervals, and how many hold the truth.
};

/// Whether two rows are of the same ordering and scene.
bool same_order(const SamplingRow& a, const SamplingRow& b);

/// In the order of the orderings' first appearance, then by falling rate. Rows without a rate, misses, exact
/// misses or seconds are left out. Rows must outlive the result.
std::vector<Accuracy> accuracies(std::span<const SamplingRow> rows);

/// A line for each; no lines without rows.
Table accuracy_table(std::span<const SamplingRow> rows);

}  // namespace regather::results
