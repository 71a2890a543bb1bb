// results/race_row.h -- an ordering on a structure, searched for real against the clock: docs/race.md.
#pragma once
#include <span>
#include <string>

#include "results/column.h"
#include "results/table.h"

namespace regather::results {

struct RaceRow {
    static const RowKind& kind();

    std::string scene;
    std::string structure;  ///< "left-balanced", "bucketed"
    std::string ordering;
    Count tile, bins;        ///< As in Row.
    std::string parameters;  ///< All parameters of the ordering as its spec.
    Count queries, photons, k;
    Number radius;  ///< Greatest radius of a search [scene units]; empty: unlimited.
    Flag gathered;  ///< Positions were copied into the order first; its time is the ordering's.
    Count threads, repeats;
    Number order_seconds_median;  ///< Keys, sort and, where `gathered`, the copy; 0 for naive.
    Number search_seconds_median, search_seconds_min, search_seconds_max;  ///< All queries.
    Number search_seconds_mad;  ///< Median absolute deviation from the median.
    Number net_gain_seconds;    ///< Median over the repeats of naive's search less search and order.
};

/// Microseconds a query; a line a row, in their order. The title is of the first row: all are of one race.
Table race_table(std::span<const RaceRow> rows);

}  // namespace regather::results
