// regather capture -- renders a scene, writes the image and the trace.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/progress.h"
#include "experiment/capture_job.h"
#include "experiment/capture_options.h"

namespace regather::cli {

void add_capture(CLI::App& app) {
    struct Options {
        std::string scene, image;
        std::filesystem::path folder;
        experiment::CaptureOptions capture;
        bool force = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("capture", "render a scene; write its image and its trace");
    command->add_option("scene", options->scene, "an embedded scene's name or a scene file")->required();
    command->add_option("-o,--output", options->folder, "folder for image.exr, image.png and trace/")
        ->required();
    options->capture.add_to(*command);
    command->add_flag("--force", options->force, "overwrite a finished capture");
    command->footer(
        "Examples:\n"
        "  regather capture room -o out/room --width 128 --height 128 --photons 100000\n"
        "  regather capture my_scene.json -o out/mine --k 50 --radius 0.3");
    command->callback([options] {
        const experiment::CaptureJob job{
            options->scene, options->capture, {}, options->folder, options->force};
        experiment::CaptureResult result;
        {
            Progress progress;
            result = experiment::run(job, progress.listener());
        }
        fmt::print("{}", result.report);
    });
}

}  // namespace regather::cli
