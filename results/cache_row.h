// results/cache_row.h -- an address trace through one cache: docs/cachesim.md.
#pragma once
#include <string>

#include "results/column.h"

namespace regather::results {

struct CacheRow {
    static const RowKind& kind();

    std::string policy;  ///< "lru"
    Count size_bytes, line_bytes;
    Count ways;                            ///< 0: fully associative, written as "full".
    Count accesses, hits, misses;          ///< Of lines.
    Count compulsory, capacity, conflict;  ///< Misses by Hill's classes.
    Count writebacks, writes_through;      ///< Dirty lines written back; writes that went past the cache.
    Count traffic_bytes;                   ///< Between the cache and what lies below it.
    std::string write, write_miss, index;  ///< "back", "allocate", "modulo"
    Count seed;                            ///< Of the policy random; empty for the others.
};

}  // namespace regather::results
