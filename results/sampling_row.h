// results/sampling_row.h -- one set-sampled run beside the exact one: how far off it was and how long it
// took.
#pragma once
#include <string>

#include "results/column.h"

namespace regather::results {

struct SamplingRow {
    static const RowKind& kind();

    std::string scene, ordering, parameters;
    Count cache_bytes, line_bytes;
    Count ways;          ///< 0: fully associative, written as "full".
    Count set_sampling;  ///< One set of this many was simulated.
    Count seed;          ///< Of the choice of sets.
    Count misses;        ///< Estimated.
    Number misses_stderr;
    Count misses_low, misses_high;  ///< 95 % confidence interval.
    Count exact_misses;
    Flag covered;                   ///< The interval holds exact_misses; written as 1 or 0.
    Number seconds, exact_seconds;  ///< Of the sampled and of the exact run.
};

}  // namespace regather::results
