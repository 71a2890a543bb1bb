#include "experiment/structure_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "replay/verification.h"
#include "spatial/photons/structures.h"
#include "trace/error.h"
#include "trace/folder.h"

namespace regather::experiment {
namespace {

namespace fs = std::filesystem;

/// Columns that say how the queries were searched.
bool of_the_search(std::string_view column) {
    static constexpr std::array<std::string_view, 5> own{"walk", "query_walk_bytes", "tree_child",
                                                         "tree_leaf_begin", "tree_photon"};
    return std::find(own.begin(), own.end(), column) != own.end();
}

}  // namespace

std::string run(const StructureJob& job, const ProgressListener& progress) {
    const spatial::StructureSpec spec = spatial::parse_structure(job.structure);
    trace::TraceReader from(job.trace);
    std::error_code error;
    if (fs::equivalent(job.trace, job.folder, error))
        throw trace::UsageError(
            fmt::format("--output: found {}, expected another folder than the trace's", job.folder.string()));
    trace::TraceInfo info = from.info();
    const std::optional<float> radius = replay::search_radius(from);
    if (!radius)
        throw trace::DataError(
            fmt::format("{}: parameters: found no radius, expected how far the queries were searched",
                        (from.folder() / "trace.json").string()));
    const std::span<const trace::Photon> photons = from.column<trace::Photon>("photon");
    const std::span<const trace::Vec3> positions = from.column<trace::Vec3>("query_position");
    const auto search = spatial::build(spec, photons, info.k, *radius);

    trace::TraceWriter writer(job.folder, job.force);  // from here on an earlier trace is gone
    for (const auto& [name, digest] : from.digests())
        if (!of_the_search(name)) writer.column(name).append_bytes(from.bytes(name));
    search->store(writer);
    info.structure = spec.text;
    info.structure_version = spec.entry->version;
    info.found_photons = info.visited_nodes = 0;
    constexpr std::uint64_t batch = 1 << 20;
    for (std::uint64_t first = 0; first < positions.size() || first == 0; first += batch) {
        const auto points =
            positions.subspan(first, std::min<std::uint64_t>(batch, positions.size() - first));
        const spatial::Recording walks = search->record(points, info.k, *radius);
        writer.column("query_walk_bytes").append(std::span<const std::uint32_t>(walks.walk_bytes));
        writer.column("walk").append(std::span<const std::uint8_t>(walks.walks));
        info.found_photons += walks.found_photons;
        info.visited_nodes += walks.visited_nodes;
        if (progress) progress("recording walks", "queries", first + points.size(), positions.size());
    }
    writer.finish(info);
    const double queries = std::max<double>(1, static_cast<double>(info.queries));
    return fmt::format("{}: {} photons, {} queries, {:.1f} elements visited a query\ntrace: {}\n",
                       info.structure, info.photons, info.queries,
                       static_cast<double>(info.visited_nodes) / queries, job.folder.string());
}

}  // namespace regather::experiment
