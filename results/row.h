// results/row.h -- one measurement: what was replayed, through which cache, what it moved and what the order
// cost. Tidy data: one row a measurement, counts with their unit in the name, a cell that does not apply
// stays empty.
#pragma once
#include <string>

#include "results/column.h"

namespace regather::results {

struct Row {
    static const RowKind& kind();

    std::string scene;
    Count frame;
    /// Of the capture: how gather rays were chosen and which cache of irradiance served points, as specs with
    /// all parameters; empty: the default, none.
    std::string sampling, irradiance_cache;
    std::string ordering;    ///< "hilbert"; whole image when tile is empty.
    Count tile;              ///< Edge of a square tile [pixels].
    Count bins;              ///< Direction bins or strata along one axis of an n x n grid.
    std::string parameters;  ///< All parameters of the ordering as its spec, "hilbert:tile=16".
    std::string structure;   ///< "left-balanced-kd"
    std::string layout;      ///< "heap-20"
    std::string policy;      ///< "lru"
    Count cache_bytes, line_bytes;
    Count ways;  ///< 0: fully associative, written as "full".
    Count queries;
    Count accesses;               ///< Line accesses.
    Count raw_bytes;              ///< Bytes asked for.
    Count oracle_bytes;           ///< Found photons x 20 B.
    Count compulsory_bytes;       ///< Distinct lines x line size.
    Count misses, traffic_bytes;  ///< Of the photons alone: lines fetched; bytes fetched and written back.
    Count compulsory, capacity, conflict;  ///< Misses by Hill's classes; their sum is `misses`.
    Count writebacks;                      ///< Dirty lines written back.
    Count onchip_bytes;                    ///< What the chip may buffer for reordering.
    Count buffer_traffic_bytes;            ///< What the reorder buffers add, through the same cache.
    Signed net_benefit_bytes;              ///< Traffic of naive less net_traffic() of this row; benefit.h.
    Count set_sampling,
        sampled_sets;               ///< One set of `set_sampling` was simulated, 1: every set; their number.
    Number misses_stderr;           ///< Standard error of `misses`, when sets were sampled ...
    Count misses_low, misses_high;  ///< ... and its 95 % confidence interval.
    Count keys, key_ops, sort_passes, moved_records, buffered_bytes, reorder_bytes, recast_rays, stalls;
    Number order_seconds;   ///< Keys and sort, measured alone.
    Number replay_seconds;  ///< One replay through all caches of its trial, beside as many others as there
                            ///< are threads: the same in each of the trial's rows.
};

}  // namespace regather::results
