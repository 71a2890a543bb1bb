// regather capture -- renders a scene, writes the image and the trace.
#include <filesystem>
#include <memory>

#include "cli/capture_options.h"
#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/progress.h"
#include "experiment/traces/capture_job.h"

namespace regather::cli {
namespace {

struct CaptureOptions {
    experiment::CaptureJob job;
};

void make_trace(const CaptureOptions& options, const Console& console) {
    experiment::CaptureResult result;
    experiment::CaptureJob job = options.job;
    const Interruption interruption;
    try {
        Progress progress(console);
        job.note = progress.note_listener();
        result = experiment::run(job, interruption.ending(progress.listener()));
    } catch (const Interrupted& interrupted) {
        throw Interrupted(interrupted.signal,
                          fmt::format("{}: interrupted: {}", options.job.folder.string(),
                                      options.job.options.frames.empty()
                                          ? "nothing is finished; the same command begins again"
                                          : "finished frames are there; the same command goes on"));
    }
    console.print("{}", result.report);
}

}  // namespace

void add_capture(Command& command) {
    auto options = std::make_shared<CaptureOptions>();
    experiment::CaptureJob& job = options->job;
    command.argument("scene", job.scene, "an embedded scene's name or a scene file").required();
    command.option("-o,--output", job.folder, "folder for image.exr, image.png and trace/").required();
    add_capture_options(command, job.options);
    command.flag("--force", job.force, "overwrite a finished capture");
    command.footer(
        "SIGINT (Ctrl-C) and SIGTERM leave the finished frames; the same command goes on from there.\n"
        "Examples:\n"
        "  regather capture room -o out/room --width 128 --height 128 --photons 100000\n"
        "  regather capture my_scene.json -o out/mine --k 50 --radius 0.3");
    command.action(options, [&command](const CaptureOptions& asked, const Console& console) {
        check_capture_options(command, asked.job.options);
        make_trace(asked, console);
    });
}

}  // namespace regather::cli
