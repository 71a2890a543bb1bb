#include "cli/measurement.h"

#include <fmt/format.h>

#include <charconv>

#include "cli/size.h"
#include "trace/error.h"

namespace regather::cli {

cachesim::CacheConfig parse_cache(std::string_view text) {
    const auto refuse = [&]() -> cachesim::CacheConfig {
        throw trace::UsageError(fmt::format("cache: found '{}', expected SIZE:LINE:WAYS as in 128K:128:8 or 16K:64:full",
                                            text));
    };
    const std::size_t first = text.find(':'), second = text.find(':', first + 1);
    if (first == std::string_view::npos || second == std::string_view::npos) return refuse();
    const std::string_view ways = text.substr(second + 1);
    cachesim::CacheConfig cache;
    cache.size_bytes = parse_size(text.substr(0, first));
    const std::uint64_t line = parse_size(text.substr(first + 1, second - first - 1));
    if (line > 0xffffffffu) return refuse();
    cache.line_bytes = static_cast<std::uint32_t>(line);
    if (ways == "full") {
        cache.ways = cachesim::fully_associative;
    } else {
        const auto [end, error] = std::from_chars(ways.data(), ways.data() + ways.size(), cache.ways);
        if (error != std::errc{} || end != ways.data() + ways.size() || cache.ways == 0) return refuse();
    }
    cachesim::check(cache);
    return cache;
}

std::string cache_text(const cachesim::CacheConfig& cache) {
    return fmt::format("{}:{}:{}", cache.size_bytes, cache.line_bytes,
                       cache.ways == cachesim::fully_associative ? "full" : std::to_string(cache.ways));
}

Measurement::Measurement(trace::TraceReader& trace, const reorder::Reads& reads, std::uint64_t onchip_bytes)
    : trace_(trace), walks_(trace), onchip_bytes_(onchip_bytes) {
    const trace::TraceInfo& info = trace.info();
    if (info.image_width == 0 || info.image_height == 0)
        throw trace::DataError(fmt::format("{}: {}: found 0, expected at least one pixel",
                                           (trace.folder() / "trace.json").string(),
                                           info.image_width == 0 ? "image_width" : "image_height"));
    work_.position = trace.column<trace::Vec3>("query_position");
    work_.pixel = trace.column<std::uint32_t>("query_pixel");
    if (reads.direction) work_.direction = trace.column<trace::Vec3>("query_direction");
    if (reads.leaf_kd) work_.leaf_kd = trace.column<std::uint32_t>("query_leaf_kd");
    if (reads.leaf_bvh) work_.leaf_bvh = trace.column<std::uint32_t>("query_leaf_bvh");
    work_.bounds = trace::bounds_of(work_.position);
    work_.image_width = trace.info().image_width;
    work_.image_height = trace.info().image_height;
}

reorder::Ordered Measurement::order(const reorder::Ordering& ordering) const {
    return reorder::order(ordering, work_, onchip_bytes_);
}

void Measurement::find_compulsory(std::span<const std::uint32_t> line_sizes) {
    const std::vector<bool> touched = replay::touched_nodes(walks_);
    for (const std::uint32_t line : line_sizes)
        compulsory_bytes[line] = replay::compulsory_bytes(touched, layout_, line);
}

std::vector<results::Row> Measurement::rows(const reorder::OrderingSpec& spec, const reorder::Ordered& ordered,
                                            std::span<const cachesim::CacheConfig> caches,
                                            const std::function<void(std::uint64_t)>& progress) const {
    const replay::Replayed replayed = replay::replay(walks_, layout_, ordered.permutation, caches, progress);
    const reorder::Cost& cost = ordered.cost;
    std::vector<results::Row> rows;
    for (const replay::CacheTraffic& traffic : replayed.caches) {
        results::Row row;
        row.scene = trace_.info().scene;
        row.ordering = spec.name;
        if (spec.tile) row.tile = *spec.tile;
        if (spec.bins) row.bins = *spec.bins;
        row.parameters = spec.text;
        row.structure = trace_.info().structure;
        row.layout = layout_.name;
        row.policy = "lru";
        row.cache_bytes = traffic.config.size_bytes;
        row.line_bytes = traffic.config.line_bytes;
        row.ways = traffic.config.ways;
        row.queries = ordered.permutation.size();
        row.accesses = traffic.accesses;
        row.raw_bytes = replayed.raw_bytes;
        row.oracle_bytes = trace_.info().found_photons * layout_.used_bytes;
        if (const auto known = compulsory_bytes.find(traffic.config.line_bytes); known != compulsory_bytes.end())
            row.compulsory_bytes = known->second;
        row.misses = traffic.misses;
        row.traffic_bytes = traffic.traffic_bytes;
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

}  // namespace regather::cli
