#include "experiment/traces/trace_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "experiment/traces/brought_queries.h"
#include "experiment/traces/walk_columns.h"
#include "spatial/photons/photon_kd.h"
#include "spatial/photons/structures.h"
#include "trace/error.h"
#include "trace/folder.h"

namespace regather::experiment {
namespace {

using trace::Vec3;

constexpr std::array<std::string_view, 1> search_columns{"photon_position"};

}  // namespace

std::string run(const TraceJob& job, const ProgressListener& progress) {
    const spatial::StructureSpec spec = spatial::parse_structure(job.structure);
    refuse_unknown_columns(job.columns, search_columns);
    const trace::MappedColumn photon_positions(job.columns / "photon_position.npy",
                                               trace::column_type<Vec3>());
    const BroughtQueries brought(job.columns);
    const std::span<const Vec3> positions = brought.positions();

    std::vector<trace::Photon> photons(photon_positions.size());
    for (std::size_t i = 0; i < photons.size(); ++i) {
        photons[i].position = photon_positions.rows<Vec3>()[i];
        if (!trace::is_finite(photons[i].position))
            throw trace::DataError(fmt::format("{}: row {}: found {} {} {}, expected finite numbers",
                                               (job.columns / "photon_position.npy").string(), i,
                                               photons[i].position.x, photons[i].position.y,
                                               photons[i].position.z));
    }
    const std::vector<trace::Photon> heap = spatial::left_balanced(photons);

    const float radius =
        job.radius > 0 ? static_cast<float>(job.radius) : std::numeric_limits<float>::infinity();
    const auto search = spatial::build(spec, heap, job.k, radius);

    trace::TraceWriter writer(job.folder, job.force);  // from here on an earlier trace is gone
    writer.column("photon").append(std::span<const trace::Photon>(heap));
    trace::TraceInfo info;
    brought.store(writer, info, job.width);
    info.k = job.k;
    const std::string figures =
        write_walks(spec, *search, positions, radius, job.candidates, writer, info, progress);
    info.photons = heap.size();
    info.parameters["radius"] = std::isfinite(radius) ? trace::Json(job.radius) : trace::Json();
    info.parameters["k"] = job.k;
    writer.finish(info);
    return fmt::format("{} photons, {} queries, {} nodes visited{}trace: {}\n", info.photons, info.queries,
                       info.visited_nodes, figures, job.folder.string());
}

}  // namespace regather::experiment
