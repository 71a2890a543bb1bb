// replay/buffered.h -- one order through several LRU caches, with the accesses of the ordering's buffers
// between the searches: the traffic of photons and of buffers, each as it is when the other takes its share
// of the cache.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/cache.h"
#include "reorder/buffer_use.h"
#include "replay/layout.h"
#include "replay/replay.h"
#include "replay/walk_store.h"

namespace regather::replay {

struct BufferedTraffic {
    cachesim::CacheConfig config;
    cachesim::CacheStats photons, buffers;
    std::uint64_t photon_bytes = 0, buffer_bytes = 0;  ///< Traffic: (misses + writebacks) x line_bytes.
};

/// A result for each cache, in the order asked for, as if it were alone; the counts are those of
/// replay_in_detail(). Every cache is simulated by itself, so a family costs as many passes as it has caches.
/// One thread; several replays of one store can run at once. Throws as replay() does.
std::vector<BufferedTraffic> replay_with_buffers(const WalkStore& walks, const Layout& layout,
                                                 std::span<const std::uint32_t> permutation,
                                                 const reorder::BufferUse& use,
                                                 std::span<const cachesim::CacheConfig> caches,
                                                 const QueriesDone& progress = {});

}  // namespace regather::replay
