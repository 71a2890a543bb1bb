// results/row.h -- one measurement: what was replayed, through which cache, what it moved and what the order cost.
// Tidy data: one row a measurement, counts with their unit in the name, a cell that does not apply stays empty.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace regather::results {

using Count = std::optional<std::uint64_t>;

struct Row {
    std::string scene;
    Count frame;
    std::string ordering;         ///< "hilbert"; whole image when tile is empty.
    Count tile;                   ///< Edge of a square tile [pixels].
    Count bins;                   ///< Direction bins along one axis of an n x n grid.
    std::string parameters;       ///< All parameters of the ordering as its spec, "hilbert:tile=16".
    std::string structure;        ///< "left-balanced-kd"
    std::string layout;           ///< "heap-20"
    std::string policy;           ///< "lru"
    Count cache_bytes, line_bytes;
    Count ways;                   ///< 0: fully associative, written as "full".
    Count queries;
    Count accesses;               ///< Line accesses.
    Count raw_bytes;              ///< Bytes asked for.
    Count oracle_bytes;           ///< Found photons x 20 B.
    Count compulsory_bytes;       ///< Distinct lines x line size.
    Count misses, traffic_bytes;
    Count keys, key_ops, sort_passes, moved_records, buffered_bytes, reorder_bytes, recast_rays, stalls;
    std::optional<double> order_seconds;   ///< Keys and sort, measured alone.
    std::optional<double> replay_seconds;  ///< One replay through all caches of its trial, beside as many others as there
                                           ///< are threads: the same in each of the trial's rows.
};

}  // namespace regather::results
