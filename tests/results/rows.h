// tests/results/rows.h -- measurements made by hand: only what a test speaks of is set.
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "results/row.h"

namespace regather::results {

/// 1000 queries on "room" through the paper's cache.
inline Row made_row(std::string ordering, Count tile, Count bins, std::uint64_t traffic_bytes) {
    Row row;
    row.scene = "room";
    row.ordering = std::move(ordering);
    row.tile = tile;
    row.bins = bins;
    row.structure = "left-balanced-kd";
    row.layout = "heap-20";
    row.policy = "lru";
    row.cache_bytes = 128 * 1024;
    row.line_bytes = 128;
    row.ways = 8;
    row.queries = 1000;
    row.traffic_bytes = traffic_bytes;
    return row;
}

inline Row with_parameters(Row row, std::string parameters) {
    row.parameters = std::move(parameters);
    return row;
}

}  // namespace regather::results
