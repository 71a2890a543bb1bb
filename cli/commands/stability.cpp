// regather stability -- stiff and extreme cases, each against an analytic or double-precision truth.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "capture/fingerprint.h"
#include "charts/chart.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "scenes/loader.h"
#include "study/stability.h"

namespace regather::cli {
namespace {

struct StabilityOptions {
    std::vector<std::string> only;
    std::filesystem::path folder;
    bool quick = false, list = false, force = false;
};

std::vector<const study::CaseGroup*> wanted_groups(const StabilityOptions& options) {
    std::vector<const study::CaseGroup*> groups;
    for (const std::string& name : options.only) groups.push_back(&study::case_group(name));
    if (groups.empty())
        for (const study::CaseGroup& group : study::case_groups()) groups.push_back(&group);
    return groups;
}

/// The cases have scenes of their own; one embedded scene stands for them.
trace::Json renderer() {
    const scenes::Scene scene = scenes::load_scene("cornell");
    return trace::Json::object({{"scene", scene.name}, {"fingerprint", capture::fingerprint(scene)}});
}

void run_stability(const StabilityOptions& options, const Console& console) {
    const auto groups = wanted_groups(options);
    if (options.list) {
        for (const study::CaseGroup* group : groups) {
            console.print("{:<10} {}\n", group->name, group->summary);
            for (const study::Case& one : group->cases()) console.print("    {}\n", one.name);
        }
        return;
    }
    const std::filesystem::path csv = options.folder / "stability.csv";
    if (!options.folder.empty()) results::refuse_to_overwrite(csv, options.force);

    std::vector<results::StabilityRow> rows;
    {
        Progress progress(console);
        rows = study::run_cases(groups, options.quick ? study::Effort::quick : study::Effort::full,
                                progress.listener());
    }
    console.print("{}", results::text_of(results::stability_table(rows)));
    if (!options.folder.empty()) {
        results::write_csv<results::StabilityRow>(csv, rows);
        results::write_provenance(csv, provenance(console, {}),
                                  trace::Json::object({{"quick", options.quick}, {"renderer", renderer()}}));
        console.print("{}\n", csv.string());
        const std::string kind = "stability";
        for (const charts::Drawn& drawn :
             charts::write_charts(options.folder, results::Rows(rows), std::span(&kind, 1), {}))
            for (const auto& file : drawn.files) console.print("{}\n", file.string());
    }
    std::size_t failed = 0;
    for (const results::StabilityRow& row : rows) failed += !row.passed.value_or(false);
    if (failed > 0) throw std::runtime_error(fmt::format("{} of {} cases failed", failed, rows.size()));
}

}  // namespace

void add_stability(Command& command) {
    auto options = std::make_shared<StabilityOptions>();
    std::string names;
    for (const study::CaseGroup& group : study::case_groups())
        names += fmt::format("{}{}", names.empty() ? "" : ", ", group.name);
    command.comma_list("--only", options->only, fmt::format("groups of cases: {}", names));
    command.option("-o,--output", options->folder, "write stability.csv and the chart here");
    command.flag("--quick", options->quick, "fewer rays, photons and samples");
    command.flag("--list", options->list, "name the cases and stop");
    command.flag("--force", options->force, "overwrite the CSV");
    command.conflict("--list", {"--output", "--quick"});
    command.needs("--force", {"--output"});
    command.footer(
        "Exit code 1 when a case fails. Meaning and bounds of the cases: docs/stability.md\n"
        "Example:\n  regather stability --only leaks,lobes -o out/stability");
    command.action(options, run_stability);
}

}  // namespace regather::cli
