// regather run -- a whole experiment: capture, every ordering, every cache, CSV and charts. Finished parts
// are kept.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>

#include "charts/chart.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "experiment/experiment.h"
#include "experiment/experiment_job.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "results/traffic_table.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
    fs::path experiment, folder;
    bool force = false;
};

experiment::ExperimentResult make(const experiment::Experiment& experiment, const RunOptions& options,
                                  const Console& console) {
    const Interruption interruption;
    try {
        Progress progress(console);
        const auto print_report = [&](const experiment::CaptureResult& captured) {
            progress.clear();
            console.print("{}", captured.report);
            std::fflush(console.out);
        };
        return experiment::run({experiment, options.folder, git_revision(), options.force,
                                progress.note_listener(), print_report},
                               interruption.ending(progress.listener()));
    } catch (const Interrupted& interrupted) {
        throw Interrupted(interrupted.signal,
                          fmt::format("{}: interrupted: finished parts are there; the same command "
                                      "goes on",
                                      options.folder.string()));
    }
}

void run_experiment(const RunOptions& options, const Console& console) {
    const experiment::Experiment experiment = experiment::load_experiment(options.experiment);
    const experiment::ExperimentResult made = make(experiment, options, console);
    const fs::path csv = options.folder / "rows.csv";
    results::write_csv(csv, made.rows);
    results::write_provenance(csv, provenance(console, fmt::format("{}", fmt::join(made.checksums, " "))),
                              made.parameters);
    const auto drawn = charts::write_charts(options.folder / "charts", results::Rows(made.rows), {}, {});
    console.print("{}", results::traffic_text(made.rows));
    for (const fs::path& folder : made.folders)
        console.print("image:  {}\n", (folder / "image.png").string());
    console.print("rows:   {}\n", csv.string());
    for (const charts::Drawn& chart : drawn) {
        if (chart.files.empty()) console.print("chart:  no {}: {}\n", chart.kind, chart.skipped);
        for (const fs::path& file : chart.files) console.print("chart:  {}\n", file.string());
    }
}

}  // namespace

void add_run(Command& command) {
    auto options = std::make_shared<RunOptions>();
    command.argument("experiment", options->experiment, "a JSON file; see docs/experiments.md").required();
    command.option("-o,--output", options->folder, "folder for everything that is made").required();
    command.flag("--force", options->force, "capture again although the folder holds another capture");
    command.footer(
        "Finished parts in the folder are kept: the same command goes on after SIGINT (Ctrl-C), SIGTERM or a "
        "crash.\n"
        "Example:\n  regather run scenes/experiments/figure4.json -o out/figure4");
    command.action(options, run_experiment);
}

}  // namespace regather::cli
