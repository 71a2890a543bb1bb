// experiment/sampling.h -- how far off sampled replays are, and how much faster: each beside the exact one.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "experiment/measurement.h"
#include "experiment/progress.h"
#include "results/sampling_row.h"
#include "trace/folder.h"

namespace regather::experiment {

struct SamplingRequest {
    const Orderings& orderings;
    std::span<const cachesim::CacheConfig> caches;
    std::span<const std::uint32_t> rates;  ///< One set of so many; at least one rate.
    std::uint64_t seeds = 4;               ///< Samples at each rate: seeds 1, 2, ...
};

/// Ordering by ordering, rate by rate, seed by seed, cache by cache. Throws trace::UsageError before anything
/// is read when a cache cannot be sampled at a rate.
std::vector<results::SamplingRow> sampling(trace::TraceReader& trace, const SamplingRequest& request,
                                           const ProgressListener& progress);

}  // namespace regather::experiment
