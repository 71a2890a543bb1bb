// replay/detail.h -- one order through one LRU cache, told apart: which data missed (photons by depth in the
// tree, the reorder buffers), why (Hill's three classes), how much of what was fetched was used, and when.
// What is counted and whom it is charged to: docs/attribution.md.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cachesim/attributed_cache.h"
#include "reorder/buffer_use.h"
#include "replay/layout.h"
#include "replay/replay.h"
#include "replay/walk_store.h"
#include "trace/region.h"

namespace regather::replay {

struct DetailConfig {
    cachesim::CacheConfig cache;
    std::uint64_t slices = 200;  ///< Of the run; no more than there are queries.
};

/// The elements of a region at one level, or all of a region that belongs to no structure.
struct DetailPart {
    trace::Region region = trace::Region::photons;
    std::optional<std::uint32_t> depth;  ///< The level: 0 at the root.
    cachesim::ClassStats stats;
    std::uint64_t traffic_bytes = 0;
};

/// Consecutive queries; accesses and misses of all regions, the bytes still to be written back not among
/// them.
struct DetailSlice {
    std::uint64_t first_query = 0, queries = 0, accesses = 0, misses = 0;
};

struct Detail {
    std::vector<DetailPart>
        parts;  ///< Every level of every region of the structure, then the reorder buffers.
    std::vector<DetailSlice> slices;
    double seconds = 0;

    /// Of a region; of all without one.
    cachesim::ClassStats sum(std::optional<trace::Region> region = {}) const;
    std::uint64_t traffic_bytes(std::optional<trace::Region> region = {}) const;
};

/// Runs the queries of `permutation` and, in step with them, the buffers' accesses, at addresses behind the
/// photons. An empty `use`, or one that is not known, makes none. One thread. Throws as replay() does.
Detail replay_in_detail(const WalkStore& walks, const Layout& layout,
                        std::span<const std::uint32_t> permutation, const reorder::BufferUse& use,
                        const DetailConfig& config, const QueriesDone& progress = {});

}  // namespace regather::replay
