// regather race -- the real searches of a trace's queries on this machine, in several orderings, against the
// clock.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "experiment/trace_race.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "results/race_row.h"
#include "trace/error.h"
#include "trace/folder.h"
#include "trace/text.h"

namespace regather::cli {
namespace {

struct RaceOptions {
    std::filesystem::path trace, csv;
    std::vector<std::string> orders{"naive", "random", "tiled", "hilbert", "hilbert:tile=16", "morton"};
    std::vector<std::string> structures{"left-balanced", "bucketed"};
    std::uint32_t k = 0, repeats = 11, threads = 1;
    std::uint64_t queries = 0;
    bool gathered = false, force = false;
};

std::vector<experiment::Structure> parse_structures(const std::vector<std::string>& words) {
    std::vector<experiment::Structure> parsed;
    for (const std::string& word : words) {
        const std::optional<experiment::Structure> structure = experiment::structure_named(word);
        if (!structure)
            throw trace::UsageError(fmt::format("--structure: found '{}', expected left-balanced or bucketed",
                                                trace::shown(word)));
        parsed.push_back(*structure);
    }
    return parsed;
}

void race(const RaceOptions& options, const Console& console) {
    if (!options.csv.empty()) results::refuse_to_overwrite(options.csv, options.force);
    experiment::TraceRace asked{.orderings = experiment::parse_orderings(options.orders),
                                .structures = parse_structures(options.structures),
                                .k = options.k,
                                .queries = options.queries,
                                .repeats = options.repeats,
                                .threads = options.threads,
                                .gathered = options.gathered};
    trace::TraceReader trace(options.trace);
    const std::vector<results::RaceRow> rows =
        experiment::race(trace, std::move(asked), Progress(console).listener());
    if (!options.csv.empty()) {
        results::write_csv<results::RaceRow>(options.csv, rows);
        results::write_provenance(options.csv, provenance(console, trace.checksum()),
                                  trace.info().parameters);
    }
    console.print("{}", results::text_of(results::race_table(rows)));
    if (!options.csv.empty()) console.print("rows: {}\n", options.csv.string());
}

}  // namespace

void add_race(Command& command) {
    auto options = std::make_shared<RaceOptions>();
    command.argument("trace", options->trace, "the folder of a finished trace").required();
    command.list("--order,--reorderer", options->orders,
                 "orderings as in replay; naive, which the others are compared with, runs in any case");
    command.comma_list("--structure", options->structures, "what is searched: left-balanced, bucketed");
    command.option("--k", options->k, {0, (1u << 31) - 1}, "photons of a gather; 0: as captured");
    command.option("--queries", options->queries, {}, "so many, from the middle of the capture; 0: all");
    command.option("--repeats", options->repeats, {1, 1000}, "of each ordering");
    command.option("--threads", options->threads, {1, 1024}, "for searches, keys and sort");
    command.flag("--gathered", options->gathered,
                 "copy the positions into the order before the search; its time counts as the ordering's");
    command.option("--csv", options->csv, "write the rows here, and X.json beside X.csv");
    command.flag("--force", options->force, "overwrite the CSV");
    command.needs("--force", {"--csv"});
    command.footer(
        "Examples:\n"
        "  regather race out/room/trace\n"
        "  regather race out/room/trace --order hilbert hilbert:tile=16 kd-leaf --structure bucketed --csv "
        "race.csv");
    command.action(options, race);
}

}  // namespace regather::cli
