// regather computation -- the floating-point operations of a frame by the paper's Table 2: the paper's own,
// and those of a capture.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "study/computation/computation.h"
#include "study/computation/computation_job.h"

namespace regather::cli {
namespace {

struct ComputationOptions {
    study::ComputationJob job;
    std::filesystem::path csv;
    bool force = false;
};

void compute(const ComputationOptions& options, const Console& console) {
    if (!options.csv.empty()) results::refuse_to_overwrite(options.csv, options.force);
    study::ComputationResult result;
    {
        Progress progress(console);
        result = study::run(options.job, progress.listener());
    }
    if (!options.csv.empty()) {
        results::write_csv<results::ComputationRow>(options.csv, result.rows);
        results::write_provenance(options.csv, provenance(console, result.checksum), result.parameters);
    }
    console.print("{}", results::text_of(result.tables));
    if (!options.csv.empty()) console.print("rows: {}\n", options.csv.string());
}

}  // namespace

void add_computation(Command& command) {
    auto options = std::make_shared<ComputationOptions>();
    std::string names;
    for (const study::ComputationParameter& parameter : study::computation_parameters())
        names += fmt::format("\n  {:<19}{:<30}{:.10g}", parameter.name, parameter.what, parameter.paper);
    command.arguments(
        "traces", options->job.traces,
        "the folder of a capture or its trace, and traces of its rays (walk --rays KIND), for what "
        "a ray visits; none: the paper's table");
    command.comma_list("--set", options->job.settings, "NAME=VALUE: a parameter in place of what is counted");
    command.option(
        "--sampling", options->job.sampling,
        "what a strategy of gather rays (capture --sampling) keeps and computes, and its FLOP in the "
        "estimate; all: a table of every strategy");
    command.option("--factor", options->job.factor, {1, false, true},
                   "each parameter alone is divided by and multiplied with it");
    command.option("--csv", options->csv, "write the rows here, and X.json beside X.csv");
    command.flag("--force", options->force, "overwrite the CSV");
    command.needs("--force", {"--csv"});
    command.footer(
        fmt::format("Parameters and the paper's values:{}\n"
                    "Meaning and sources: docs/computation.md\n"
                    "Examples:\n"
                    "  regather computation\n"
                    "  regather computation --set gather_rays=102,gathers=102\n"
                    "  regather computation --sampling combined:rows=8,columns=32\n"
                    "  regather computation out/room out/eye out/shadow out/gather --csv room.csv",
                    names));
    command.action(options, compute);
}

}  // namespace regather::cli
