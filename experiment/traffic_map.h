// experiment/traffic_map.h -- which pixels move how many bytes, by ordering.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "cachesim/cache.h"
#include "experiment/measurement.h"
#include "experiment/progress.h"
#include "trace/folder.h"

namespace regather::experiment {

inline constexpr std::uint64_t most_map_pixels = std::uint64_t{1} << 26;  ///< 0.5 GB a map.

struct TrafficMap {
    std::string ordering;
    std::vector<std::uint64_t> bytes;  ///< By pixel in row order.
};

/// One for each ordering. Throws trace::DataError for an image of more than most_map_pixels.
std::vector<TrafficMap> traffic_maps(trace::TraceReader& trace, const Orderings& orderings,
                                     const cachesim::CacheConfig& cache, const ProgressListener& progress);

}  // namespace regather::experiment
