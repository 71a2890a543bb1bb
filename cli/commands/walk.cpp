// regather walk -- makes a trace of somebody else's photons and queries, of what another program has walked,
// or of a trace's queries in another structure.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "experiment/traces/ray_job.h"
#include "experiment/traces/structure_job.h"
#include "experiment/traces/trace_job.h"
#include "experiment/traces/visits_job.h"
#include "spatial/rays/ray_structures.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::cli {
namespace {

struct WalkOptions {
    experiment::TraceJob job;
    std::string structure, rays, scene;
    std::optional<std::uint32_t> k, width;
    std::optional<double> radius;
    bool allow_overlaps = false;
};

void refuse_candidates(const WalkOptions& options, std::string_view found) {
    if (options.job.candidates)
        throw trace::UsageError(
            fmt::format("--candidates: found {}, expected photons that are searched for", found));
}

void refuse_overlaps(const WalkOptions& options) {
    if (options.allow_overlaps)
        throw trace::UsageError(
            fmt::format("--allow-overlaps: found {} without visit_element.npy, expected "
                        "visits that are brought",
                        options.job.columns.string()));
}

/// The folder is a finished trace.
experiment::StructureJob again(const WalkOptions& options) {
    if (options.k || options.width || options.radius)
        throw trace::UsageError(
            fmt::format("{}: found a finished trace, whose k, radius and width are its own, expected no --k, "
                        "--radius or --width",
                        options.job.columns.string()));
    refuse_overlaps(options);
    return {.trace = options.job.columns,
            .folder = options.job.folder,
            .structure = options.structure.empty() ? options.job.structure : options.structure,
            .candidates = options.job.candidates,
            .force = options.job.force};
}

experiment::VisitsJob of_visits(const WalkOptions& options) {
    refuse_candidates(options, "visits that are brought");
    if (options.k || options.radius || !options.structure.empty())
        throw trace::UsageError(
            fmt::format("{}: found visit_element.npy, the walks of a search that is done, expected no --k, "
                        "--radius or --structure",
                        options.job.columns.string()));
    return {.columns = options.job.columns,
            .folder = options.job.folder,
            .width = options.width.value_or(0),
            .allow_overlaps = options.allow_overlaps,
            .force = options.job.force};
}

experiment::RayJob of_rays(const WalkOptions& options) {
    refuse_overlaps(options);
    refuse_candidates(options, "--rays");
    if (options.k || options.width || options.radius)
        throw trace::UsageError("--rays: found --k, --radius or --width, expected none: rays have no such");
    experiment::RayJob job{.trace = options.job.columns,
                           .folder = options.job.folder,
                           .rays = options.rays,
                           .scene = options.scene,
                           .force = options.job.force};
    if (!options.structure.empty()) job.structure = options.structure;
    return job;
}

experiment::TraceJob of_columns(const WalkOptions& options) {
    refuse_overlaps(options);
    experiment::TraceJob job = options.job;
    if (!options.structure.empty()) job.structure = options.structure;
    if (options.k) job.k = *options.k;
    if (options.width) job.width = *options.width;
    if (options.radius) job.radius = *options.radius;
    return job;
}

std::string report(const WalkOptions& options, const experiment::ProgressListener& progress) {
    if (!options.rays.empty()) return experiment::run(of_rays(options), progress);
    if (!options.scene.empty())
        throw trace::UsageError("--scene: found no --rays, whose triangles it gives, expected both or none");
    if (spatial::is_ray_structure(options.structure))
        throw trace::UsageError(
            fmt::format("--structure: found {}, which rays are cast through, expected --rays with it",
                        trace::shown(options.structure)));
    std::error_code error;
    if (std::filesystem::exists(options.job.columns / "trace.json", error))
        return experiment::run(again(options), progress);
    return experiment::brings_visits(options.job.columns) ? experiment::run(of_visits(options), progress)
                                                          : experiment::run(of_columns(options), progress);
}

void make_walks(const WalkOptions& options, const Console& console) {
    std::string text;
    {
        Progress progress(console);
        text = report(options, progress.listener());
    }
    console.print("{}", text);
}

}  // namespace

void add_walk(Command& command) {
    auto options = std::make_shared<WalkOptions>();
    experiment::TraceJob& job = options->job;
    command
        .argument(
            "folder", job.columns,
            "a finished trace; or a folder with photon_position.npy and query_position.npy (float32, n "
            "x 3) and, if you have them, "
            "query_pixel.npy (uint32), query_direction.npy, query_weight.npy (float32, n x 3); or, in place "
            "of "
            "photons, visit_element.npy, query_visits.npy and element_bytes.npy (docs/bringing_walks.md)")
        .required();
    command.option("-o,--output", job.folder, "the trace's folder").required();
    command.option("--structure", options->structure,
                   "what the photons are searched in, or the rays cast through, see regather structures; "
                   "left-balanced-kd, for rays ray-bvh");
    command.option(
        "--rays", options->rays,
        "of a captured trace, make a trace of its rays of one kind: eye, specular, shadow or gather");
    command.option(
        "--scene", options->scene,
        "the scene file of the capture, where the scene is not one of regather scenes; for --rays");
    command.option("--k", options->k, {1, (1u << 31) - 1}, "photons of a search; 100");
    command.option("--radius", options->radius, {.least = 0, .infinite = true},
                   "maximum radius [units of the positions]; 0 or inf: unlimited");
    command.option("--width", options->width, {1}, "image width that query_pixel counts with [pixels]");
    command.flag("--candidates", job.candidates,
                 "also tell which photons entered a search's list of the k nearest so far (columns candidate "
                 "and query_candidate_bytes)");
    command.flag("--allow-overlaps", options->allow_overlaps,
                 "elements of brought visits may share bytes at their addresses");
    command.flag("--force", job.force, "overwrite a finished trace");
    command.footer(
        "Examples:\n"
        "  regather walk my_columns -o out/mine --k 50 --width 640\n"
        "  regather walk out/room/trace --structure median-kd:leaf=8 -o out/room-median\n"
        "  regather walk out/room/trace --rays gather --structure bvh-4 -o out/room-gather-rays");
    command.action(options, make_walks);
}

}  // namespace regather::cli
