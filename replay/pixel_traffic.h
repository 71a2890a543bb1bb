// replay/pixel_traffic.h -- which pixel moved the bytes: each miss of one LRU cache, charged to the pixel of
// the query that missed.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/cache.h"
#include "replay/layout.h"
#include "replay/replay.h"
#include "replay/walk_store.h"

namespace regather::replay {

/// Bytes fetched by pixel: misses x line size, cache empty at first. `query_pixel[q]` < `pixels` is the pixel
/// of query q. The sum is the traffic that replay() tells of the same order and cache. One thread. Throws
/// trace::DataError for a pixel outside the image, and as replay() does.
std::vector<std::uint64_t> pixel_traffic(const WalkStore& walks, const Layout& layout,
                                         std::span<const std::uint32_t> permutation,
                                         std::span<const std::uint32_t> query_pixel, std::uint64_t pixels,
                                         const cachesim::CacheConfig& config,
                                         const QueriesDone& progress = {});

}  // namespace regather::replay
