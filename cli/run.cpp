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
#include "experiment/capture_job.h"
#include "experiment/experiment.h"
#include "experiment/parts.h"
#include "results/benefit.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "results/traffic_table.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
    fs::path experiment, folder;
    bool force = false;
};

/// All rows, and what they are of.
struct Made {
    std::vector<fs::path> folders;  ///< One a frame.
    std::vector<results::Row> rows;
    std::vector<std::string> checksums;
    trace::Json parameters;
};

Made make(const experiment::Experiment& experiment, const Options& options, const Console& console) {
    const Interruption interruption;
    const trace::FolderLock lock(options.folder);
    try {
        Progress progress(console);
        const experiment::ProgressListener listener = interruption.ending(progress.listener());
        const experiment::CaptureResult captured =
            experiment::run({experiment.scene, experiment.capture, experiment::reads(experiment),
                             options.folder, options.force, progress.note_listener()},
                            listener);
        progress.clear();
        console.print("{}", captured.report);
        std::fflush(console.out);
        Made made{captured.folders, {}, {}, {}};
        for (const fs::path& folder : captured.folders) {
            trace::TraceReader trace(folder / "trace");
            for (results::Row& row : rows_of(trace, experiment, {folder / "parts", git_revision()}, listener))
                made.rows.push_back(std::move(row));
            made.checksums.push_back(trace.checksum());
            made.parameters = trace.info().parameters;
        }
        return made;
    } catch (const Interrupted& interrupted) {
        throw Interrupted(interrupted.signal,
                          fmt::format("{}: interrupted: finished parts are there; the same command "
                                      "goes on",
                                      options.folder.string()));
    }
}

void run(const Options& options, const Console& console) {
    const experiment::Experiment experiment = experiment::load_experiment(options.experiment);
    Made made = make(experiment, options, console);
    if (made.folders.size() > 1) made.parameters["frame"] = experiment.capture.frames;
    results::fill_net_benefit(made.rows);
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
    auto options = std::make_shared<Options>();
    command.argument("experiment", options->experiment, "a JSON file; see docs/experiments.md").required();
    command.option("-o,--output", options->folder, "folder for everything that is made").required();
    command.flag("--force", options->force, "capture again although the folder holds another capture");
    command.footer(
        "Finished parts in the folder are kept: the same command goes on after SIGINT (Ctrl-C), SIGTERM or a "
        "crash.\n"
        "Example:\n  regather run scenes/experiments/figure4.json -o out/figure4");
    command.action(options, run);
}

}  // namespace regather::cli
