// regather walk -- makes a trace of somebody else's photons and queries, or of a trace's in another
// structure.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "experiment/ray_job.h"
#include "experiment/structure_job.h"
#include "experiment/trace_job.h"
#include "spatial/rays/ray_structures.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::cli {
namespace {

struct Options {
    experiment::TraceJob job;
    std::string structure, rays, scene;
    std::optional<std::uint32_t> k, width;
    std::optional<double> radius;
};

/// The folder is a finished trace.
experiment::StructureJob again(const Options& options) {
    if (options.k || options.width || options.radius)
        throw trace::UsageError(
            fmt::format("{}: found a finished trace, whose k, radius and width are its own, expected no --k, "
                        "--radius or --width",
                        options.job.columns.string()));
    return {.trace = options.job.columns,
            .folder = options.job.folder,
            .structure = options.job.structure,
            .force = options.job.force};
}

experiment::RayJob of_rays(const Options& options) {
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

experiment::TraceJob of_columns(const Options& options) {
    experiment::TraceJob job = options.job;
    if (options.k) job.k = *options.k;
    if (options.width) job.width = *options.width;
    if (options.radius) job.radius = *options.radius;
    return job;
}

std::string report(const Options& options, const experiment::ProgressListener& progress) {
    if (!options.rays.empty()) return experiment::run(of_rays(options), progress);
    if (!options.scene.empty())
        throw trace::UsageError("--scene: found no --rays, whose triangles it gives, expected both or none");
    if (spatial::is_ray_structure(options.job.structure))
        throw trace::UsageError(
            fmt::format("--structure: found {}, which rays are cast through, expected --rays with it",
                        trace::shown(options.job.structure)));
    std::error_code error;
    return std::filesystem::exists(options.job.columns / "trace.json", error)
               ? experiment::run(again(options), progress)
               : experiment::run(of_columns(options), progress);
}

void run(const Options& given, const Console& console) {
    Options options = given;
    if (!options.structure.empty()) options.job.structure = options.structure;
    std::string text;
    {
        Progress progress(console);
        text = report(options, progress.listener());
    }
    console.print("{}", text);
}

}  // namespace

void add_walk(Command& command) {
    auto options = std::make_shared<Options>();
    experiment::TraceJob& job = options->job;
    command
        .argument("folder", job.columns,
                  "a finished trace; or a folder with photon_position.npy and query_position.npy (float32, n "
                  "x 3) and, if you have them, "
                  "query_pixel.npy (uint32), query_direction.npy, query_weight.npy (float32, n x 3)")
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
    command.flag("--force", job.force, "overwrite a finished trace");
    command.footer(
        "Examples:\n"
        "  regather walk my_columns -o out/mine --k 50 --width 640\n"
        "  regather walk out/room/trace --structure median-kd:leaf=8 -o out/room-median\n"
        "  regather walk out/room/trace --rays gather --structure bvh-4 -o out/room-gather-rays");
    command.action(options, run);
}

}  // namespace regather::cli
