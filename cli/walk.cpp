// regather walk -- makes a trace of somebody else's photons and queries, or of a trace's in another
// structure.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "experiment/structure_job.h"
#include "experiment/trace_job.h"
#include "trace/error.h"

namespace regather::cli {
namespace {

struct Options {
    experiment::TraceJob job;
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

experiment::TraceJob of_columns(const Options& options) {
    experiment::TraceJob job = options.job;
    if (options.k) job.k = *options.k;
    if (options.width) job.width = *options.width;
    if (options.radius) job.radius = *options.radius;
    return job;
}

void run(const Options& options, const Console& console) {
    std::string report;
    {
        Progress progress(console);
        std::error_code error;
        report = std::filesystem::exists(options.job.columns / "trace.json", error)
                     ? experiment::run(again(options), progress.listener())
                     : experiment::run(of_columns(options), progress.listener());
    }
    console.print("{}", report);
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
    command.option("--structure", job.structure, "what the photons are searched in, see regather structures");
    command.option("--k", options->k, {1, (1u << 31) - 1}, "photons of a search; 100");
    command.option("--radius", options->radius, {.least = 0, .infinite = true},
                   "maximum radius [units of the positions]; 0 or inf: unlimited");
    command.option("--width", options->width, {1}, "image width that query_pixel counts with [pixels]");
    command.flag("--force", job.force, "overwrite a finished trace");
    command.footer(
        "Examples:\n"
        "  regather walk my_columns -o out/mine --k 50 --width 640\n"
        "  regather walk out/room/trace --structure median-kd:leaf=8 -o out/room-median");
    command.action(options, run);
}

}  // namespace regather::cli
