// regather frame -- the rays and photon queries of one frame through one memory system, together and apart.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cachesim/cache_list.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "experiment/address_sweep.h"
#include "experiment/combined_frame.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "trace/size.h"

namespace regather::cli {
namespace {

struct FrameOptions {
    experiment::CombinedFrame frame;
    std::filesystem::path csv;
    std::vector<std::string> units{"pixel"}, caches{"128K:128:8"};
    std::string onchip = "1M", machines;
    bool force = false;
};

void replay_frame(const FrameOptions& options, const Console& console) {
    if (!options.csv.empty()) results::refuse_to_overwrite(options.csv, options.force);
    experiment::CombinedFrame frame = options.frame;
    frame.units = options.units;
    frame.onchip_bytes = trace::parse_size(options.onchip);
    if (!options.machines.empty()) {
        frame.machines = experiment::load_machines(options.machines);
    } else {
        for (const cachesim::CacheConfig& cache : cachesim::parse_caches(options.caches))
            frame.machines.push_back(experiment::machine_of(cache));
    }
    experiment::FrameResult result;
    {
        Progress progress(console);
        result = experiment::run(frame, progress.listener());
    }
    if (options.csv.empty()) return console.print("{}", results::to_csv<results::FrameRow>(result.rows));
    results::write_csv<results::FrameRow>(options.csv, result.rows);
    results::write_provenance(options.csv, provenance(console, result.checksum), result.parameters);
    console.print("{}rows: {}\n", results::text_of(results::frame_table(result.rows)), options.csv.string());
}

}  // namespace

void add_frame(Command& command) {
    auto options = std::make_shared<FrameOptions>();
    command
        .arguments(
            "traces", options->frame.traces,
            "finished traces of one capture in the order of their turns: rays of walk --rays, then what "
            "searches for photons")
        .required();
    command
        .sequence("--order,--reorderer", options->frame.orderings,
                  "orderings as for replay: one for all traces, or one for each")
        .required();
    command.sequence(
        "--layout", options->frame.layouts,
        "layouts as for replay: one for all traces, or one for each; without, each structure's default");
    command.list("--unit", options->units,
                 "when the next trace's turn comes: after each pixel, tile=N (N x N pixels), or frame");
    command.list("--cache", options->caches, "caches as SIZE:LINE:WAYS; WAYS may be full");
    command.option(
        "--machine", options->machines,
        "in place of --cache: memory systems, by name (see regather machines) or file, with commas");
    command.option("--onchip", options->onchip, "bytes that the chip can buffer");
    command.option("--csv", options->csv, "write the rows here, and X.json beside X.csv");
    command.flag("--force", options->force, "overwrite the CSV");
    command.conflict("--machine", {"--cache"});
    command.needs("--force", {"--csv"});
    command.footer(
        "Example:\n"
        "  regather frame out/eye out/shadow out/specular out/gather out/room/trace --order naive --unit "
        "pixel\n"
        "    tile=16 frame --machine paper-128k,gpu-a100 --csv frame.csv");
    command.action(options, replay_frame);
}

}  // namespace regather::cli
