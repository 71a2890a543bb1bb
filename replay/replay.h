// replay/replay.h -- runs recorded walks in an order: walks -> nodes -> bytes -> lines -> caches. Nothing is searched.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cachesim/cache.h"
#include "replay/layout.h"
#include "replay/walk_store.h"

namespace regather::replay {

/// What went through one cache.
struct CacheTraffic {
    cachesim::CacheConfig config;
    std::uint64_t accesses = 0;       ///< Line accesses; a node on two lines makes two.
    std::uint64_t misses = 0;
    std::uint64_t traffic_bytes = 0;  ///< misses x line_bytes: a replay only reads.
};

struct Replayed {
    std::uint64_t visited_nodes = 0;
    std::uint64_t raw_bytes = 0;  ///< visited_nodes x bytes used of a node.
    std::vector<CacheTraffic> caches;  ///< In the order asked for.
    double seconds = 0;
};

/// Runs the queries in the order of `permutation` (indices below walks.queries(); need not be all) through each
/// cache, as if it were alone. `progress` is told the queries done now and then. One thread; several replays of one
/// store can run at once. Throws trace::DataError with the query's number when a walk does not fit its tree.
Replayed replay(const WalkStore& walks, const HeapLayout& layout, std::span<const std::uint32_t> permutation,
                std::span<const cachesim::CacheConfig> caches,
                const std::function<void(std::uint64_t)>& progress = {});

/// The nodes that any query visits, as a bitmap over slots (bit s: slot s, counted from 1). In parallel.
std::vector<bool> touched_nodes(const WalkStore& walks);

/// Compulsory traffic: the different lines on which the touched nodes lie, times the line size.
std::uint64_t compulsory_bytes(const std::vector<bool>& touched, const HeapLayout& layout, std::uint32_t line_bytes);

}  // namespace regather::replay
