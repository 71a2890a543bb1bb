#include "experiment/measurement.h"

#include <fmt/format.h>

#include <set>

#include "experiment/workload.h"
#include "replay/buffered.h"
#include "replay/layouts/catalogue.h"
#include "replay/levels.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::experiment {

Orderings parse_orderings(std::span<const std::string> specs) {
    Orderings orderings;
    std::set<std::string> seen;
    for (const std::string& spec : specs) {
        const reorder::ParsedOrdering& parsed = orderings.all.emplace_back(reorder::parse_ordering(spec));
        orderings.reads |= parsed.ordering->reads();
        if (!seen.insert(parsed.spec.text).second)
            throw trace::UsageError(fmt::format("ordering {}: found {} twice, expected each ordering once",
                                                trace::shown(spec), parsed.spec.text));
    }
    return orderings;
}

Measurement::Measurement(trace::TraceReader& trace, const reorder::Reads& reads, std::uint64_t onchip_bytes)
    : trace_(trace),
      walks_(trace),
      layout_(replay::usual_layout(walks_.structure())),
      work_(workload(trace, reads)),
      onchip_bytes_(onchip_bytes) {}

void Measurement::lay_out(std::string_view spec) {
    lay_out(replay::make_layout(spec, walks_.structure(), record_positions()));
}

void Measurement::lay_out(replay::Layout layout) {
    layout_ = std::move(layout);
    revisits_.clear();
    line_use_.clear();
    compulsory_bytes.clear();
}

reorder::Ordered Measurement::order(const reorder::Ordering& ordering) const {
    return reorder::order(ordering, work_, onchip_bytes_);
}

void Measurement::find_compulsory(std::span<const std::uint32_t> line_sizes) {
    const std::vector<bool> touched = replay::touched_elements(walks_);
    for (const std::uint32_t line : line_sizes)
        compulsory_bytes[line] = replay::compulsory_bytes(touched, layout_, line);
}

void Measurement::prepare(std::span<const cachesim::CacheConfig> caches, const Method& method,
                          const std::function<void(std::uint64_t)>& progress) {
    method_ = method;
    if (method.sampling) {
        replay::SetSample::check(caches, *method.sampling);
        line_use_ = replay::count_line_use(walks_, layout_, caches, progress);
    } else {
        revisits_ = replay::count_revisits(walks_, layout_, {{caches.begin(), caches.end()}, method.classes},
                                           progress);
    }
}

void Measurement::prepare(const replay::Revisits& revisits, const Method& method) {
    method_ = method;
    revisits_ = revisits;
}

replay::Replayed Measurement::replayed(std::span<const std::uint32_t> permutation,
                                       std::span<const cachesim::CacheConfig> caches,
                                       const std::function<void(std::uint64_t)>& progress) const {
    if (method_.sampling)
        return replay::SetSample(walks_, layout_, caches, *method_.sampling, line_use_)
            .replay(permutation, progress);
    return replay::replay(walks_, layout_, permutation, {{caches.begin(), caches.end()}, method_.classes},
                          revisits_, progress);
}

void Measurement::through(const reorder::Ordered& ordered, std::span<cachesim::Hierarchy> systems,
                          const std::function<void(std::uint64_t)>& progress) const {
    replay::replay_levels(walks_, layout_, ordered.permutation, systems, progress);
    for (cachesim::Hierarchy& system : systems) system.flush();
}

std::vector<results::Row> Measurement::rows(const reorder::ParsedOrdering& parsed,
                                            const reorder::Ordered& ordered,
                                            std::span<const cachesim::CacheConfig> caches,
                                            const std::function<void(std::uint64_t)>& progress) const {
    const replay::Replayed replayed = this->replayed(ordered.permutation, caches, progress);
    const reorder::OrderingSpec& spec = parsed.spec;
    const reorder::Cost& cost = ordered.cost;
    std::vector<replay::BufferedTraffic> buffered;
    if (method_.buffers) {
        const reorder::BufferUse use = buffer_use(*parsed.ordering, ordered);
        if (use.known && !use.empty())
            buffered =
                replay::replay_with_buffers(walks_, layout_, ordered.permutation, use, caches, progress);
    }
    std::vector<results::Row> rows;
    for (const replay::CacheTraffic& traffic : replayed.caches) {
        results::Row row;
        row.scene = trace_.info().scene;
        if (trace_.info().frame) row.frame = *trace_.info().frame;
        row.ordering = spec.name;
        if (spec.tile) row.tile = *spec.tile;
        if (spec.bins) row.bins = *spec.bins;
        row.parameters = spec.text;
        row.structure = trace_.info().structure;
        if (trace_.info().map != "global") row.structure += " " + trace_.info().map;
        if (const trace::Json* const kind = trace_.info().parameters.find("rays"); kind && kind->text())
            row.structure += fmt::format(" {} rays", trace::shown(*kind->text()));
        row.layout = layout_.name();
        row.policy = "lru";
        row.cache_bytes = traffic.config.size_bytes;
        row.line_bytes = traffic.config.line_bytes;
        row.ways = traffic.config.ways;
        row.queries = ordered.permutation.size();
        row.accesses = traffic.accesses;
        row.raw_bytes = replayed.raw_bytes;
        row.oracle_bytes = trace_.info().found_photons * sizeof(trace::Photon);
        if (const auto known = compulsory_bytes.find(traffic.config.line_bytes);
            known != compulsory_bytes.end())
            row.compulsory_bytes = known->second;
        row.misses = traffic.misses;
        row.traffic_bytes = traffic.traffic_bytes;
        if (traffic.classes) {
            row.compulsory = traffic.classes->compulsory;
            row.capacity = traffic.classes->capacity;
            row.conflict = traffic.classes->conflict;
        }
        if (traffic.error) {
            row.set_sampling = method_.sampling->one_of;
            row.sampled_sets = traffic.error->sampled_sets;
            row.misses_stderr = traffic.error->standard_error;
            row.misses_low = traffic.error->low;
            row.misses_high = traffic.error->high;
        }
        row.onchip_bytes = onchip_bytes_;
        if (!buffered.empty()) {
            const replay::BufferedTraffic& both = buffered[rows.size()];
            row.buffer_traffic_bytes = both.photon_bytes + both.buffer_bytes - traffic.traffic_bytes;
        } else if (method_.buffers && cost.reorder_bytes == 0) {
            row.buffer_traffic_bytes = 0;
        }
        row.keys = cost.keys;
        row.key_ops = cost.key_ops;
        row.sort_passes = cost.sort_passes;
        row.moved_records = cost.moved_records;
        row.buffered_bytes = cost.buffered_bytes;
        row.reorder_bytes = cost.reorder_bytes;
        row.recast_rays = cost.recast_rays;
        row.stalls = cost.stalls;
        row.order_seconds = ordered.seconds;
        row.replay_seconds = replayed.seconds;
        rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace regather::experiment
