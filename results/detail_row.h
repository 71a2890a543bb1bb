// results/detail_row.h -- which data missed: the accesses of one replay by region and by depth in the tree.
#pragma once
#include <string>

#include "results/column.h"

namespace regather::results {

struct DetailRow {
    static const RowKind& kind();

    std::string scene, ordering;
    Count tile, bins;  ///< As in Row.
    std::string parameters, layout, policy;
    Count cache_bytes, line_bytes;
    Count ways;          ///< 0: fully associative, written as "full".
    std::string region;  ///< "photons", "reorder_buffer"
    Count tree_depth;    ///< 0 at the root; empty for regions that are no tree.
    Count accesses, misses;
    Count compulsory, capacity, conflict;  ///< Misses by Hill's classes.
    Count traffic_bytes;                   ///< Bytes fetched and written back for this region and depth.
    Count used_bytes;  ///< Bytes of fetched lines that were used before eviction; overfetch = traffic / used.
};

}  // namespace regather::results
