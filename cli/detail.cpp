// regather detail -- one cache, told apart: which data missed, why, how much of what was fetched was used,
// and when.
#include <CLI/CLI.hpp>
#include <memory>

#include "cli/commands.h"
#include "experiment/attribution.h"

namespace regather::cli {

void add_detail(CLI::App& app) {
    auto options = std::make_shared<Attribution>();
    CLI::App* command =
        app.add_subcommand("detail", "tell apart which data misses in a cache, why, and when");
    command->add_option("trace", options->trace, "the folder of a finished trace")->required();
    command
        ->add_option("--order,--reorderer", options->orders,
                     "orderings as NAME:parameter=value,...; or the path of a shared library")
        ->required();
    command->add_option("--cache", options->caches, "caches as SIZE:LINE:WAYS; WAYS may be full")
        ->capture_default_str();
    command->add_option("--onchip", options->onchip, "bytes that the chip can buffer")->capture_default_str();
    command->add_option("--slices", options->slices, "slices of the run in the timeline")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 32))
        ->capture_default_str();
    command->add_flag("--no-buffers", options->no_buffers, "leave out the accesses of reorder buffers");
    command->add_option("--csv", options->csv,
                        "write rows by region and tree depth here, and X.json beside X.csv");
    command->add_option("--timeline", options->timeline, "write rows by slice of the run here, likewise");
    command->add_flag("--force", options->force, "overwrite the files");
    command->footer(
        "Example:\n"
        "  regather detail out/room/trace --order naive hilbert hilbert:tile=16 --csv detail.csv --timeline "
        "timeline.csv");
    command->callback([options] { attribute(*options); });
}

}  // namespace regather::cli
