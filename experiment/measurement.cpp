#include "experiment/measurement.h"

#include <fmt/format.h>

#include <set>

#include "experiment/workload.h"
#include "replay/buffered.h"
#include "replay/layouts/catalogue.h"
#include "replay/levels.h"
#include "trace/error.h"
#include "trace/free_memory.h"
#include "trace/text.h"

namespace regather::experiment {

namespace {

replay::ReplayConfig replay_config(std::span<const cachesim::CacheConfig> caches, const Method& method) {
    return {{caches.begin(), caches.end()}, method.classes, method.several_orders};
}

/// Empty where the capture does not tell.
std::string text_parameter(const trace::TraceInfo& info, std::string_view key) {
    const trace::Json* const value = info.parameters.find(key);
    return value && value->text() ? *value->text() : "";
}

}  // namespace

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
      layout_(replay::make_layout(replay::default_layout(walks_.structure()), walks_.structure())),
      work_(workload(trace, reads)),
      onchip_bytes_(onchip_bytes) {}

void Measurement::lay_out(std::string_view spec) {
    lay_out(replay::make_layout(spec, walks_.structure(), record_positions()));
}

void Measurement::lay_out(replay::Layout layout) {
    layout_ = std::move(layout);
    revisits_.clear();
    line_use_.clear();
    first_touches_.reset();
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
        revisits_ = replay::count_revisits(walks_, layout_, replay_config(caches, method), progress);
    }
}

void Measurement::prepare(const replay::Revisits& revisits, const Method& method) {
    method_ = method;
    revisits_ = revisits;
}

void Measurement::hold_first_touches(std::span<const cachesim::CacheConfig> caches,
                                     const std::function<void(std::uint64_t)>& progress) {
    const std::uint64_t most_bytes = trace::free_memory() / 2;
    std::set<std::uint32_t> sizes;
    for (const cachesim::CacheConfig& cache : caches)
        if (replay::family_serves(cache)) sizes.insert(cache.line_bytes);
    if (sizes.empty()) return;
    first_touches_.emplace(walks_, layout_, std::vector<std::uint32_t>(sizes.begin(), sizes.end()),
                           most_bytes, progress);
}

replay::Replayed Measurement::replayed(std::span<const std::uint32_t> permutation,
                                       std::span<const cachesim::CacheConfig> caches,
                                       const std::function<void(std::uint64_t)>& progress) const {
    if (method_.sampling)
        return replay::SetSample(walks_, layout_, caches, *method_.sampling, line_use_)
            .replay(permutation, progress);
    const replay::ReplayConfig config = replay_config(caches, method_);
    return first_touches_
               ? replay::replay(walks_, layout_, permutation, config, revisits_, *first_touches_, progress)
               : replay::replay(walks_, layout_, permutation, config, revisits_, progress);
}

void Measurement::through(const reorder::Ordered& ordered, std::span<cachesim::Hierarchy> systems,
                          const std::function<void(std::uint64_t)>& progress) const {
    replay::replay_levels(walks_, layout_, ordered.permutation, systems, progress);
    for (cachesim::Hierarchy& system : systems) system.flush();
}

std::string Measurement::structure_name() const {
    std::string name = trace_.info().structure;
    if (trace_.info().map != "global") name += " " + trace_.info().map;
    if (const trace::Json* const kind = trace_.info().parameters.find("rays"); kind && kind->text())
        name += fmt::format(" {} rays", trace::shown(*kind->text()));
    return name;
}

results::Row Measurement::row(const reorder::ParsedOrdering& parsed, const reorder::Ordered& ordered,
                              const cachesim::CacheConfig& cache) const {
    const reorder::OrderingSpec& spec = parsed.spec;
    const reorder::Cost& cost = ordered.cost;
    results::Row row;
    row.scene = trace_.info().scene;
    if (trace_.info().frame) row.frame = *trace_.info().frame;
    row.sampling = text_parameter(trace_.info(), "sampling");
    row.irradiance_cache = text_parameter(trace_.info(), "irradiance_cache");
    row.ordering = spec.name;
    if (spec.tile) row.tile = *spec.tile;
    if (spec.bins) row.bins = *spec.bins;
    row.parameters = spec.text;
    row.structure = structure_name();
    row.layout = layout_.name();
    row.policy = "lru";
    row.cache_bytes = cache.size_bytes;
    row.line_bytes = cache.line_bytes;
    row.ways = cache.ways;
    row.queries = ordered.permutation.size();
    row.oracle_bytes = trace_.info().found_photons * sizeof(trace::Photon);
    if (const auto known = compulsory_bytes.find(cache.line_bytes); known != compulsory_bytes.end())
        row.compulsory_bytes = known->second;
    row.onchip_bytes = onchip_bytes_;
    row.keys = cost.keys;
    row.key_ops = cost.key_ops;
    row.sort_passes = cost.sort_passes;
    row.moved_records = cost.moved_records;
    row.buffered_bytes = cost.buffered_bytes;
    row.reorder_bytes = cost.reorder_bytes;
    row.recast_rays = cost.recast_rays;
    row.stalls = cost.stalls;
    row.order_seconds = ordered.seconds;
    return row;
}

std::vector<results::Row> Measurement::rows(const reorder::ParsedOrdering& parsed,
                                            const reorder::Ordered& ordered,
                                            std::span<const cachesim::CacheConfig> caches,
                                            const std::function<void(std::uint64_t)>& progress) const {
    const replay::Replayed replayed = this->replayed(ordered.permutation, caches, progress);
    std::vector<replay::BufferedTraffic> buffered;
    if (method_.buffers) {
        const reorder::BufferUse use = buffer_use(*parsed.ordering, ordered);
        if (use.known && !use.empty())
            buffered =
                replay::replay_with_buffers(walks_, layout_, ordered.permutation, use, caches, progress);
    }
    std::vector<results::Row> rows;
    for (const replay::CacheTraffic& traffic : replayed.caches) {
        results::Row row = this->row(parsed, ordered, traffic.config);
        row.accesses = traffic.accesses;
        row.raw_bytes = replayed.raw_bytes;
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
        if (!buffered.empty()) {
            const replay::BufferedTraffic& both = buffered[rows.size()];
            row.buffer_traffic_bytes = both.photon_bytes + both.buffer_bytes - traffic.traffic_bytes;
        } else if (method_.buffers && ordered.cost.reorder_bytes == 0) {
            row.buffer_traffic_bytes = 0;
        }
        row.replay_seconds = replayed.seconds;
        rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace regather::experiment
