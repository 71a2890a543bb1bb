#include "experiment/attribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cli/progress.h"
#include "cli/version.h"
#include "experiment/measurement.h"
#include "replay/detail.h"
#include "results/csv.h"
#include "results/geometry.h"
#include "results/provenance.h"
#include "trace/error.h"
#include "trace/size.h"

namespace regather::cli {
namespace {

/// Before anything is computed. Looks at the provenance beside each CSV, too.
void check_outputs(const Attribution& asked) {
    std::vector<std::filesystem::path> files;
    for (const auto& [option, csv] : {std::pair{"--csv", asked.csv}, {"--timeline", asked.timeline}}) {
        if (csv.empty()) continue;
        const std::filesystem::path json = results::provenance_path(csv);
        if (json == csv)
            throw trace::UsageError(fmt::format(
                "{}: found {}, expected another ending than .json, which the provenance beside it bears",
                option, csv.string()));
        files.push_back(csv);
        files.push_back(json);
    }
    if (files.size() == 4 && files[1] == files[3])
        throw trace::UsageError(
            fmt::format("--timeline: found {}, expected another name than that of --csv, for the "
                        "provenance beside it",
                        asked.timeline.string()));
    if (asked.force) return;
    for (const std::filesystem::path& file : files)
        if (std::filesystem::exists(file))
            throw trace::UsageError(fmt::format("{}: exists; --force overwrites it", file.string()));
}

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

/// An ordering through a cache, as the table tells it.
struct Line {
    std::string ordering;
    replay::Detail detail;
    std::string reorder_bytes;
    bool buffers;
};

std::string percentages(const cachesim::ClassStats& stats) {
    if (stats.misses == 0) return "";
    const auto share = [&](std::uint64_t part) {
        return 100 * static_cast<double>(part) / static_cast<double>(stats.misses);
    };
    return fmt::format("{:.1f}/{:.1f}/{:.1f}", share(stats.compulsory), share(stats.capacity),
                       share(stats.conflict));
}

std::string table(std::span<const Line> lines) {
    constexpr std::size_t columns = 7;
    std::vector<std::array<std::string, columns>> cells{
        {"ordering", "photons", "buffers", "sum", "overfetch", "3C [%]", "counted reorder"}};
    for (const Line& line : lines) {
        const cachesim::ClassStats sum = line.detail.sum();
        const std::uint64_t traffic = line.detail.traffic_bytes();
        cells.push_back(
            {line.ordering, results::decimal_bytes(line.detail.traffic_bytes(trace::Region::photons)),
             line.buffers ? results::decimal_bytes(line.detail.traffic_bytes(trace::Region::reorder_buffer))
                          : "",
             results::decimal_bytes(traffic),
             sum.used_bytes == 0
                 ? ""
                 : fmt::format("{:.2f}", static_cast<double>(traffic) / static_cast<double>(sum.used_bytes)),
             percentages(sum), line.reorder_bytes});
    }
    std::array<std::size_t, columns> widths{};
    for (const auto& row : cells)
        for (std::size_t c = 0; c < columns; ++c) widths[c] = std::max(widths[c], row[c].size());
    std::string out;
    for (const auto& row : cells) {
        std::string text = fmt::format("{:<{}}", row[0], widths[0]);
        for (std::size_t c = 1; c < columns; ++c) text += fmt::format("  {:>{}}", row[c], widths[c]);
        out += text.substr(0, text.find_last_not_of(' ') + 1) + '\n';
    }
    return out;
}

template <class R>
void write(const std::filesystem::path& csv, const std::vector<R>& rows, const trace::TraceReader& trace) {
    if (csv.empty()) return;
    results::write_csv<R>(csv, rows);
    results::write_provenance(csv, {command_line(), version(), git_revision(), trace.checksum()},
                              trace.info().parameters);
}

}  // namespace

void attribute(const Attribution& asked) {
    check_outputs(asked);
    auto [orderings, reads] = parse_orderings(asked.orders);
    std::vector<cachesim::CacheConfig> caches;
    for (const std::string& text : asked.caches)
        for (const cachesim::CacheConfig& cache : parse_caches(text)) caches.push_back(cache);
    const std::uint64_t onchip = parse_size(asked.onchip);
    trace::TraceReader trace(asked.trace);
    const Measurement measurement(trace, reads, onchip);
    const std::string& scene = trace.info().scene;

    std::vector<results::DetailRow> rows;
    std::vector<results::TimelineRow> slices;
    std::vector<std::vector<Line>> lines(caches.size());  // by cache
    bool unknown = false;
    {
        Progress progress;
        for (std::size_t o = 0; o < orderings.size(); ++o) {
            const reorder::ParsedOrdering& parsed = orderings[o];
            const reorder::Ordered ordered = measurement.order(*parsed.ordering);
            reorder::BufferUse use;
            if (!asked.no_buffers) use = measurement.buffer_use(*parsed.ordering, ordered);
            const bool buffers = !asked.no_buffers && (use.known || ordered.cost.reorder_bytes == 0);
            unknown |= !asked.no_buffers && !buffers;
            for (std::size_t c = 0; c < caches.size(); ++c) {
                replay::Detail detail =
                    replay::replay_in_detail(measurement.walks(), measurement.layout(), ordered.permutation,
                                             use, {caches[c], asked.slices}, [&](std::uint64_t done) {
                                                 progress.update("replaying " + parsed.spec.text, "queries",
                                                                 done, measurement.queries());
                                             });
                for (const replay::DetailPart& part : detail.parts) {
                    if (part.region == trace::Region::reorder_buffer && !buffers) continue;
                    auto row = row_of<results::DetailRow>(scene, parsed.spec, caches[c]);
                    row.layout = measurement.layout().name;
                    row.policy = "lru";
                    row.region = trace::region_names[static_cast<std::size_t>(part.region)];
                    if (part.depth) row.tree_depth = *part.depth;
                    row.accesses = part.stats.accesses;
                    row.misses = part.stats.misses;
                    row.compulsory = part.stats.compulsory;
                    row.capacity = part.stats.capacity;
                    row.conflict = part.stats.conflict;
                    row.traffic_bytes = part.traffic_bytes;
                    row.used_bytes = part.stats.used_bytes;
                    rows.push_back(std::move(row));
                }
                for (std::size_t s = 0; s < detail.slices.size(); ++s) {
                    const replay::DetailSlice& slice = detail.slices[s];
                    auto row = row_of<results::TimelineRow>(scene, parsed.spec, caches[c]);
                    row.slice = s;
                    row.first_query = slice.first_query;
                    row.queries = slice.queries;
                    row.accesses = slice.accesses;
                    row.misses = slice.misses;
                    slices.push_back(std::move(row));
                }
                lines[c].push_back({asked.orders[o], std::move(detail),
                                    results::decimal_bytes(ordered.cost.reorder_bytes), buffers});
            }
        }
    }
    write(asked.csv, rows, trace);
    write(asked.timeline, slices, trace);
    for (std::size_t c = 0; c < caches.size(); ++c)
        fmt::print("{}{} | {} queries | {} | on chip {}\n{}", c == 0 ? "" : "\n", scene,
                   results::decimal_count(static_cast<double>(measurement.queries())), cache_text(caches[c]),
                   asked.onchip, table(lines[c]));
    fmt::print(
        "traffic = fetched and written back; overfetch = traffic / bytes used; 3C = compulsory / capacity / "
        "conflict misses\n");
    if (unknown) fmt::print("a library's buffers are not simulated: how they are used is not known\n");
    if (!asked.csv.empty()) fmt::print("rows: {}\n", asked.csv.string());
    if (!asked.timeline.empty()) fmt::print("timeline: {}\n", asked.timeline.string());
}

}  // namespace regather::cli
