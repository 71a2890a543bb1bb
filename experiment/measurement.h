// experiment/measurement.h -- one trace, put into orders and replayed: the wiring from columns to result
// rows.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cachesim/cache.h"
#include "cachesim/machines/hierarchy.h"
#include "reorder/catalogue.h"
#include "replay/first_touches.h"
#include "replay/replay.h"
#include "replay/set_sample.h"
#include "results/row.h"
#include "spatial/photons/structures.h"
#include "trace/folder.h"

namespace regather::experiment {

/// Orderings by their specs, and the columns that any of them looks at. Throws as reorder::parse_ordering(),
/// and trace::UsageError for one that is there twice.
struct Orderings {
    std::vector<reorder::ParsedOrdering> all;
    reorder::Reads reads;
};
Orderings parse_orderings(std::span<const std::string> specs);

/// How caches are measured.
struct Method {
    bool classes = false;  ///< Misses by Hill's classes, too.
    bool buffers = false;  ///< What the orderings' buffers add to the traffic, too: a pass for each cache.
    bool several_orders = false;  ///< To be replayed: what they share is worth finding even for one cache.
    std::optional<replay::Sampling> sampling;  ///< Some of the sets; all when there is none.
};

class Measurement {
public:
    /// `reads`: the columns that the orderings to come look at. The reader outlives the measurement.
    Measurement(trace::TraceReader& trace, const reorder::Reads& reads, std::uint64_t onchip_bytes);

    std::uint64_t queries() const { return walks_.queries(); }
    const replay::WalkStore& walks() const { return walks_; }
    const replay::Layout& layout() const { return layout_; }
    const trace::TraceInfo& info() const { return trace_.info(); }
    /// As rows say it: the spec, and what is searched where it is not the global photon map.
    std::string structure_name() const;
    /// Another layout by its spec (replay/layouts/catalogue.h, also for errors); what was prepared and found
    /// for the one before is forgotten. default_layout() at first.
    void lay_out(std::string_view spec);
    void lay_out(replay::Layout layout);
    /// Of the photons, as the structure counts its records; of rays none.
    std::vector<trace::Vec3> record_positions() const { return spatial::record_positions(trace_); }
    reorder::Ordered order(const reorder::Ordering& ordering) const;
    /// What the ordering's buffers do in memory; `ordered` is its order().
    reorder::BufferUse buffer_use(const reorder::Ordering& ordering, const reorder::Ordered& ordered) const {
        return ordering.buffer_use(work_, onchip_bytes_, ordered.permutation);
    }

    /// Finds what the replays of all orders through these caches share. On all cores; `progress` is told
    /// queries done.
    void prepare(std::span<const cachesim::CacheConfig> caches, const Method& method,
                 const std::function<void(std::uint64_t)>& progress);
    /// Another sample, after prepare() with one.
    void sample(const replay::Sampling& sampling) { method_.sampling = sampling; }
    const replay::Revisits& revisits() const { return revisits_; }
    /// In place of prepare() without sampling: what it found before, of these caches or more.
    void prepare(const replay::Revisits& revisits, const Method& method);

    /// All that a row says but what a replay finds. The ordering's cost is that of `ordered`.
    results::Row row(const reorder::ParsedOrdering& parsed, const reorder::Ordered& ordered,
                     const cachesim::CacheConfig& cache) const;
    std::uint64_t onchip_bytes() const { return onchip_bytes_; }

    /// Holds the walks' first touches for the rows to come, as many as half of the free memory takes. Changes
    /// how long rows() takes, no row. Pays from two orders on. On all cores.
    void hold_first_touches(std::span<const cachesim::CacheConfig> caches,
                            const std::function<void(std::uint64_t)>& progress);

    /// A row for each cache, in their order, all of them prepared. Any number of threads may call.
    std::vector<results::Row> rows(const reorder::ParsedOrdering& parsed, const reorder::Ordered& ordered,
                                   std::span<const cachesim::CacheConfig> caches,
                                   const std::function<void(std::uint64_t)>& progress) const;
    /// One of the orders through each memory system, from empty to flushed.
    void through(const reorder::Ordered& ordered, std::span<cachesim::Hierarchy> systems,
                 const std::function<void(std::uint64_t)>& progress) const;
    /// Finds the compulsory traffic for the line sizes; rows() then tells it. Walks the whole trace once.
    void find_compulsory(std::span<const std::uint32_t> line_sizes);
    std::map<std::uint32_t, std::uint64_t> compulsory_bytes;  ///< By line size.

private:
    replay::Replayed replayed(std::span<const std::uint32_t> permutation,
                              std::span<const cachesim::CacheConfig> caches,
                              const std::function<void(std::uint64_t)>& progress) const;

    trace::TraceReader& trace_;
    replay::WalkStore walks_;
    replay::Layout layout_;
    reorder::Workload work_;
    std::uint64_t onchip_bytes_;
    Method method_;
    replay::Revisits revisits_;
    replay::LineUse line_use_;
    std::optional<replay::FirstTouches> first_touches_;
};

}  // namespace regather::experiment
