// regather reference -- renders a scene by path tracing, for as long as it takes: stops, goes on, adds
// samples.
#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/progress.h"
#include "experiment/reference_job.h"
#include "experiment/traces/capture_options.h"

namespace regather::cli {
namespace {

struct ReferenceOptions {
    experiment::ReferenceJob job;
    std::optional<std::uint32_t> samples;
    std::optional<double> seconds;
};

void make_reference(const ReferenceOptions& options, const Console& console) {
    experiment::ReferenceJob job = options.job;
    job.goal = {options.samples.value_or(options.seconds ? std::numeric_limits<std::uint32_t>::max() : 256),
                options.seconds.value_or(std::numeric_limits<double>::infinity())};
    const Interruption interruption;
    try {
        const capture::Reference reference = [&] {
            Progress progress(console);
            job.note = progress.note_listener();
            return experiment::run(job, interruption.ending(progress.listener()));
        }();
        console.print("{}", experiment::report(reference, job.folder));
    } catch (const Interrupted& interrupted) {
        throw Interrupted(interrupted.signal,
                          fmt::format("{}: interrupted: its samples are there; the same command "
                                      "goes on",
                                      job.folder.string()));
    }
}

}  // namespace

void add_reference(Command& command) {
    auto options = std::make_shared<ReferenceOptions>();
    experiment::ReferenceJob& job = options->job;
    command.argument("scene", job.scene, "an embedded scene's name or a scene file").required();
    command.option("-o,--output", job.folder, "folder for reference.exr, variance.exr and the samples' state")
        .required();
    command.option("--width", job.width, {1, experiment::most_pixels}, "image width [pixels]");
    command.option("--height", job.height, {1, experiment::most_pixels}, "image height [pixels]");
    command.option("--samples", options->samples, {1},
                   "samples a pixel in all, those of earlier runs included (256 without --seconds)");
    command.option("--seconds", options->seconds, {.least = 0, .above = true},
                   "time in all, that of earlier runs included");
    command.option("--frame", job.frame, {}, "of the scene's camera path; without: the standing camera");
    command.option("--seed", job.seed, {}, "of all random numbers");
    command.footer(
        "Saves every 30 seconds and at SIGINT (Ctrl-C) and SIGTERM; the same command goes on from there.\n"
        "Examples:\n"
        "  regather reference room -o out/room-reference --width 128 --height 128 --samples 64\n"
        "  regather reference room -o out/room-reference --width 128 --height 128 --samples 1024\n"
        "  regather reference room -o out/long --seconds 3600");
    command.action(options, make_reference);
}

}  // namespace regather::cli
