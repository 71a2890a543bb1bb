// regather results -- which rows a change of the renderer has outdated.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <vector>

#include "cli/command.h"
#include "cli/commands.h"
#include "study/outdated.h"

namespace regather::cli {
namespace {

struct ResultsOptions {
    std::filesystem::path folder;
    std::vector<std::string> scenes;
};

void list_results(const ResultsOptions& options, const Console& console) {
    const std::vector<study::Result> all = study::find_results(
        options.folder, std::vector<std::filesystem::path>(options.scenes.begin(), options.scenes.end()));
    console.print("{}", results::text_of(study::result_table(all)));
    const auto sound = std::count_if(all.begin(), all.end(), [](const study::Result& result) {
        return result.standing == study::Standing::current || result.standing == study::Standing::unaffected;
    });
    if (const auto others = static_cast<std::ptrdiff_t>(all.size()) - sound; others > 0)
        throw std::runtime_error(fmt::format("{}: {} of {} files are not known to be of this renderer",
                                             options.folder.string(), others, all.size()));
}

}  // namespace

void add_results(Command& command) {
    auto options = std::make_shared<ResultsOptions>();
    command.argument("folder", options->folder, "where the CSVs lie, or folders with them").required();
    command.list("--scene", options->scenes, "scene files that the rows are of, beside the embedded scenes");
    command.footer(
        "Each X.json beside X.csv names the renderer by a fingerprint of its scene (docs/experiments.md), "
        "which is\n"
        "made again. Exit code 1 when one differs or cannot be told.\n"
        "Example:\n  regather results results");
    command.action(options, list_results);
}

}  // namespace regather::cli
