// cli/measurement.h -- one trace, put into orders and replayed: the wiring from columns to result rows.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "cachesim/cache.h"
#include "reorder/catalogue.h"
#include "replay/replay.h"
#include "results/row.h"
#include "trace/folder.h"

namespace regather::cli {

/// "128K:128:8" or "128K:128:full". Throws trace::UsageError.
cachesim::CacheConfig parse_cache(std::string_view text);
std::string cache_text(const cachesim::CacheConfig& cache);  ///< "131072:128:8"

class Measurement {
public:
    /// `reads`: the columns that the orderings to come look at. The reader outlives the measurement.
    Measurement(trace::TraceReader& trace, const reorder::Reads& reads, std::uint64_t onchip_bytes);

    std::uint64_t queries() const { return walks_.queries(); }
    reorder::Ordered order(const reorder::Ordering& ordering) const;
    /// A row for each cache, in their order. Any number of threads may call.
    std::vector<results::Row> rows(const reorder::OrderingSpec& spec, const reorder::Ordered& ordered,
                                   std::span<const cachesim::CacheConfig> caches,
                                   const std::function<void(std::uint64_t)>& progress) const;
    /// Finds the compulsory traffic for the line sizes; rows() then tells it. Walks the whole trace once.
    void find_compulsory(std::span<const std::uint32_t> line_sizes);
    std::map<std::uint32_t, std::uint64_t> compulsory_bytes;  ///< By line size.

private:
    trace::TraceReader& trace_;
    replay::WalkStore walks_;
    replay::HeapLayout layout_;
    reorder::Workload work_;
    std::uint64_t onchip_bytes_;
};

}  // namespace regather::cli
