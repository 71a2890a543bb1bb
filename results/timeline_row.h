// results/timeline_row.h -- misses over the run: one replay cut into slices of consecutive queries.
#pragma once
#include <string>

#include "results/column.h"

namespace regather::results {

struct TimelineRow {
    static const RowKind& kind();

    std::string scene, ordering;
    Count tile, bins;  ///< As in Row.
    std::string parameters;
    Count cache_bytes, line_bytes;
    Count ways;                       ///< 0: fully associative, written as "full".
    Count slice;                      ///< From 0.
    Count first_query;                ///< In the order of the replay, from 0.
    Count queries, accesses, misses;  ///< Of this slice.
};

}  // namespace regather::results
