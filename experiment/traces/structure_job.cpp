#include "experiment/traces/structure_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "experiment/traces/walk_columns.h"
#include "replay/verification.h"
#include "spatial/photons/structures.h"
#include "trace/error.h"
#include "trace/folder.h"

namespace regather::experiment {
namespace {

namespace fs = std::filesystem;

/// Columns that say how the queries were searched.
bool of_the_search(std::string_view column) {
    static constexpr std::array<std::string_view, 7> own{
        "walk",       "query_walk_bytes", "candidate",  "query_candidate_bytes",
        "tree_child", "tree_leaf_begin",  "tree_photon"};
    return std::find(own.begin(), own.end(), column) != own.end() || column.starts_with("element_");
}

/// Whether both have the same columns but for those of the search.
bool same_queries(const trace::TraceReader& a, const trace::TraceReader& b) {
    const auto taken_over = [](const trace::TraceReader& trace) {
        auto all = trace.digests();
        std::erase_if(all, [](const auto& column) { return of_the_search(column.first); });
        return all;
    };
    return taken_over(a) == taken_over(b);
}

}  // namespace

std::string run(const StructureJob& job, const ProgressListener& progress) {
    const spatial::StructureSpec spec = spatial::parse_structure(job.structure);
    trace::TraceReader from(job.trace);
    std::error_code error;
    if (fs::equivalent(job.trace, job.folder, error))
        throw trace::UsageError(
            fmt::format("--output: found {}, expected another folder than the trace's", job.folder.string()));
    const std::span<const trace::Photon> photons = from.column<trace::Photon>("photon");
    trace::TraceInfo info = from.info();
    const std::optional<float> radius = replay::search_radius(from);
    if (!radius)
        throw trace::DataError(
            fmt::format("{}: parameters: found no radius, expected how far the queries were searched",
                        (from.folder() / "trace.json").string()));
    replay::refuse_normals(from);
    const std::span<const trace::Vec3> positions = from.column<trace::Vec3>("query_position");
    const auto search = spatial::build(spec, photons, info.k, *radius);

    trace::TraceWriter writer(job.folder, job.force);  // from here on an earlier trace is gone
    for (const auto& [name, digest] : from.digests())
        if (!of_the_search(name)) writer.column(name).append_bytes(from.bytes(name));
    const std::string figures =
        write_walks(spec, *search, positions, *radius, job.candidates, writer, info, progress);
    writer.finish(info);
    const double queries = std::max<double>(1, static_cast<double>(info.queries));
    return fmt::format("{}: {} photons, {} queries, {:.1f} elements visited a query{}trace: {}\n",
                       info.structure, info.photons, info.queries,
                       static_cast<double>(info.visited_nodes) / queries, figures, job.folder.string());
}

bool is_done(const StructureJob& job) {
    const spatial::StructureSpec spec = spatial::parse_structure(job.structure);
    const trace::TraceReader from(job.trace);
    if (!fs::exists(job.folder / "trace.json")) return false;
    try {
        trace::TraceReader made(job.folder);
        const trace::TraceInfo& info = made.info();
        if (info.structure != spec.text || info.structure_version != spec.entry->version ||
            info.k != from.info().k || info.parameters != from.info().parameters ||
            made.has("candidate") != job.candidates || !same_queries(from, made))
            return false;
        made.verify_all();
        return true;
    } catch (const trace::DataError&) {
        return false;
    }
}

}  // namespace regather::experiment
