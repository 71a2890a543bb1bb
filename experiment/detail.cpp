#include "experiment/detail.h"

#include <fmt/format.h>

#include <algorithm>

#include "replay/detail.h"
#include "results/geometry.h"

namespace regather::experiment {
namespace {

/// What every row of a replay says of it.
template <class R>
R row_of(const std::string& scene, const reorder::OrderingSpec& spec, const cachesim::CacheConfig& cache) {
    R row;
    row.scene = scene;
    row.ordering = spec.name;
    if (spec.tile) row.tile = *spec.tile;
    if (spec.bins) row.bins = *spec.bins;
    row.parameters = spec.text;
    row.cache_bytes = cache.size_bytes;
    row.line_bytes = cache.line_bytes;
    row.ways = cache.ways;
    return row;
}

std::string percentages(const cachesim::ClassStats& stats) {
    if (stats.misses == 0) return "";
    const auto share = [&](std::uint64_t part) {
        return 100 * static_cast<double>(part) / static_cast<double>(stats.misses);
    };
    return fmt::format("{:.1f}/{:.1f}/{:.1f}", share(stats.compulsory), share(stats.capacity),
                       share(stats.conflict));
}

/// Appends the rows of one replay.
void add_rows(Detail& result, const replay::Detail& detail, const results::DetailRow& like,
              const results::TimelineRow& like_slice, bool buffers) {
    for (const replay::DetailPart& part : detail.parts) {
        if (part.region == trace::Region::reorder_buffer && !buffers) continue;
        results::DetailRow& row = result.rows.emplace_back(like);
        row.region = trace::region_names[static_cast<std::size_t>(part.region)];
        if (part.depth) row.tree_depth = *part.depth;
        row.accesses = part.stats.accesses;
        row.misses = part.stats.misses;
        row.compulsory = part.stats.compulsory;
        row.capacity = part.stats.capacity;
        row.conflict = part.stats.conflict;
        row.traffic_bytes = part.traffic_bytes;
        row.used_bytes = part.stats.used_bytes;
    }
    for (std::size_t s = 0; s < detail.slices.size(); ++s) {
        const replay::DetailSlice& slice = detail.slices[s];
        results::TimelineRow& row = result.slices.emplace_back(like_slice);
        row.slice = s;
        row.first_query = slice.first_query;
        row.queries = slice.queries;
        row.accesses = slice.accesses;
        row.misses = slice.misses;
    }
}

}  // namespace

Detail detail(const Measurement& measurement, const std::string& scene, const DetailRequest& request,
              const ProgressListener& progress) {
    Detail result;
    result.lines.resize(request.caches.size());
    for (const reorder::ParsedOrdering& parsed : request.orderings) {
        const reorder::Ordered ordered = measurement.order(*parsed.ordering);
        reorder::BufferUse use;
        if (request.buffers) use = measurement.buffer_use(*parsed.ordering, ordered);
        const bool buffers = request.buffers && (use.known || ordered.cost.reorder_bytes == 0);
        result.unknown_buffers |= request.buffers && !buffers;
        for (std::size_t c = 0; c < request.caches.size(); ++c) {
            const cachesim::CacheConfig& cache = request.caches[c];
            const replay::Detail told = replay::replay_in_detail(
                measurement.walks(), measurement.layout(), ordered.permutation, use, {cache, request.slices},
                listening(progress, "replaying " + parsed.spec.text, "queries", measurement.queries()));
            auto row = row_of<results::DetailRow>(scene, parsed.spec, cache);
            row.layout = measurement.layout().name();
            row.policy = "lru";
            add_rows(result, told, row, row_of<results::TimelineRow>(scene, parsed.spec, cache), buffers);
            DetailLine& line = result.lines[c].emplace_back();
            line.ordering = parsed.spec.text;
            line.sum = told.sum();
            line.traffic_bytes = told.traffic_bytes();
            const std::uint64_t buffer_bytes = told.traffic_bytes(trace::Region::reorder_buffer);
            line.structure_bytes = line.traffic_bytes - buffer_bytes;
            if (buffers) line.buffer_bytes = buffer_bytes;
            line.reorder_bytes = ordered.cost.reorder_bytes;
        }
    }
    return result;
}

results::Table detail_table(std::span<const DetailLine> lines) {
    results::Table out({{"ordering", results::Align::left},
                        {"structure"},
                        {"buffers"},
                        {"sum"},
                        {"overfetch"},
                        {"3C [%]"},
                        {"counted reorder"}});
    for (const DetailLine& line : lines)
        out.add({line.ordering, results::decimal_bytes(line.structure_bytes),
                 line.buffer_bytes ? results::decimal_bytes(*line.buffer_bytes) : "",
                 results::decimal_bytes(line.traffic_bytes),
                 line.sum.used_bytes == 0
                     ? ""
                     : fmt::format("{:.2f}", static_cast<double>(line.traffic_bytes) /
                                                 static_cast<double>(line.sum.used_bytes)),
                 percentages(line.sum), results::decimal_bytes(line.reorder_bytes)});
    return out;
}

}  // namespace regather::experiment
