// experiment/treelet_replay.h -- an order of rays that feeds treelet queues (replay/treelet_queues.h),
// through caches or memory systems: rows.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "experiment/measurement.h"
#include "replay/treelet_queues.h"

namespace regather::experiment {

/// Every size of a treelet ("16K") with every number of rays under way. Throws trace::UsageError for a size
/// that is none, is not 1 to 2^30, or is there twice, and for a number of rays that is there twice.
std::vector<replay::TreeletConfig> treelet_configs(std::span<const std::string> sizes,
                                                   std::span<const std::uint32_t> rays);

/// The order in which rays are made, and the queues that they are put into.
struct TreeletFeed {
    const reorder::ParsedOrdering& parsed;
    const reorder::Ordered& ordered;
    replay::TreeletConfig config;
};

/// "origin-end+treelets", "origin-end+treelets:bits=8,treelet=16384,rays=4096".
reorder::OrderingSpec spec_of(const TreeletFeed& feed);

/// A row for each cache, in their order. traffic_bytes is that of the walks, with the entries of stacks that
/// running rays have in memory; buffer_traffic_bytes what queues in memory, and the buffers of the order, add
/// to it through the same cache (empty when the order does not tell of its buffers). Those of the cost are
/// the order's and the queues': `moved_records` counts a ray put into a queue.
std::vector<results::Row> treelet_rows(const Measurement& measurement, const TreeletFeed& feed,
                                       std::span<const cachesim::CacheConfig> caches,
                                       const std::function<void(std::uint64_t)>& progress);

/// Through each memory system, from empty to flushed; the buffers of the order are left out, as they are of
/// other replays through machines.
void through_treelets(const Measurement& measurement, const TreeletFeed& feed,
                      std::span<cachesim::Hierarchy> systems,
                      const std::function<void(std::uint64_t)>& progress);

}  // namespace regather::experiment
