// experiment/detail.h -- one trace, orderings and caches in; rows by region and tree depth, rows by slice of
// the run, and a table out: docs/attribution.md.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cachesim/attributed_cache.h"
#include "experiment/measurement.h"
#include "experiment/progress.h"
#include "results/detail_row.h"
#include "results/table.h"
#include "results/timeline_row.h"

namespace regather::experiment {

struct DetailRequest {
    std::span<const reorder::ParsedOrdering> orderings;
    std::span<const cachesim::CacheConfig> caches;
    std::uint64_t slices = 200;  ///< At least 1.
    bool buffers = true;         ///< With the accesses of reorder buffers, where they are known.
};

/// An ordering through a cache.
struct DetailLine {
    std::string ordering;
    cachesim::ClassStats sum;                      ///< Of all regions.
    std::uint64_t traffic_bytes, structure_bytes;  ///< Of all; of what was searched.
    std::optional<std::uint64_t> buffer_bytes;  ///< None when the accesses of its buffers were not simulated.
    std::uint64_t reorder_bytes;                ///< As the ordering's cost counts them.
};

struct Detail {
    std::vector<results::DetailRow> rows;
    std::vector<results::TimelineRow> slices;
    std::vector<std::vector<DetailLine>> lines;  ///< By cache, then by ordering.
    bool unknown_buffers = false;                ///< Of a library: asked for, not simulated.
};

/// Every ordering through every cache, ordering by ordering. The measurement is of `scene`.
Detail detail(const Measurement& measurement, const std::string& scene, const DetailRequest& request,
              const ProgressListener& progress);

/// What people read of one cache's lines: traffic by region, overfetch, shares of the classes of misses.
results::Table detail_table(std::span<const DetailLine> lines);

}  // namespace regather::experiment
