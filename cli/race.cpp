// regather race -- the real searches of a trace's queries on this machine, in several orderings, against the
// clock.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "experiment/measurement.h"
#include "experiment/race.h"
#include "experiment/workload.h"
#include "replay/verification.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "results/race_row.h"
#include "spatial/photon_kd.h"
#include "trace/error.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

struct Options {
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
            throw trace::UsageError(
                fmt::format("--structure: found '{}', expected left-balanced or bucketed", word));
        parsed.push_back(*structure);
    }
    return parsed;
}

/// All of the trace's queries, or a contiguous part from the middle of the capture.
reorder::Workload raced(trace::TraceReader& trace, const reorder::Reads& reads, std::uint64_t asked_for) {
    const std::uint64_t all = trace.info().queries, wanted = asked_for == 0 ? all : asked_for;
    if (wanted > all)
        throw trace::UsageError(
            fmt::format("--queries: found {}, expected at most the trace's {}", wanted, all));
    if (all == 0)
        throw trace::DataError(fmt::format("{}: found no queries, expected at least 1",
                                           (trace.folder() / "query_position.npy").string()));
    return experiment::middle_of(experiment::workload(trace, reads), wanted);
}

struct Result {
    const trace::TraceInfo& info;
    const std::vector<reorder::ParsedOrdering>& orderings;
    const experiment::RaceConfig& config;
    std::uint64_t queries;
    experiment::Race race;
};

std::vector<results::RaceRow> rows_of(const Result& result) {
    std::vector<results::RaceRow> rows;
    for (const experiment::Standing& standing : result.race.standings) {
        const reorder::OrderingSpec& spec = result.orderings[standing.ordering].spec;
        results::RaceRow& row = rows.emplace_back();
        row.scene = result.info.scene;
        row.structure = name(standing.structure);
        row.ordering = spec.name;
        row.tile = spec.tile;
        row.bins = spec.bins;
        row.parameters = spec.text;
        row.queries = result.queries;
        row.photons = result.info.photons;
        row.k = result.config.k;
        if (std::isfinite(result.config.radius)) row.radius = result.config.radius;
        row.gathered = result.config.gathered;
        row.threads = result.config.threads;
        row.repeats = result.config.repeats;
        row.order_seconds_median = standing.order.median;
        row.search_seconds_median = standing.search.median;
        row.search_seconds_min = standing.search.min;
        row.search_seconds_max = standing.search.max;
        row.search_seconds_mad = standing.search.mad;
        row.net_gain_seconds = standing.net_gain;
    }
    return rows;
}

results::Table table_of(const Result& result, std::span<const results::RaceRow> rows) {
    results::Table table = results::race_table(rows);
    table.title =
        fmt::format("{} | {} queries | {} photons | k {} | {} thread{} | medians of {} repeats",
                    result.info.scene, result.queries, result.info.photons, result.config.k,
                    result.config.threads, result.config.threads == 1 ? "" : "s", result.config.repeats);
    return table;
}

void race(const Options& options, const Console& console) {
    if (!options.csv.empty()) results::refuse_to_overwrite(options.csv, options.force);
    auto [orderings, reads] = experiment::parse_orderings(options.orders);
    const auto is_naive = [](const reorder::ParsedOrdering& ordering) {
        return ordering.spec.text == "naive";
    };
    if (std::none_of(orderings.begin(), orderings.end(), is_naive))
        orderings.insert(orderings.begin(), reorder::parse_ordering("naive"));
    const auto baseline = static_cast<std::size_t>(
        std::find_if(orderings.begin(), orderings.end(), is_naive) - orderings.begin());

    experiment::RaceConfig config;
    config.structures = parse_structures(options.structures);
    config.repeats = options.repeats;
    config.threads = options.threads;
    config.gathered = options.gathered;

    trace::TraceReader trace(options.trace);
    const trace::TraceInfo& info = trace.info();
    config.k = options.k == 0 ? info.k : options.k;
    config.radius = replay::search_radius(info).value_or(std::numeric_limits<float>::infinity());
    const std::span<const trace::Photon> heap = trace.column<trace::Photon>("photon");
    const spatial::PhotonKd tree(heap);
    if (const std::uint32_t node = spatial::first_disorder(tree); node != tree.size())
        throw trace::DataError(fmt::format("{}: row {} breaks the order of a left-balanced kd-tree",
                                           (trace.folder() / "photon.npy").string(), node));
    const reorder::Workload work = raced(trace, reads, options.queries);

    Result result{info, orderings, config, work.position.size(), {}};
    {
        Progress progress(console);
        result.race = experiment::race(heap, work, orderings, baseline, config,
                                       [&](std::uint64_t done, std::uint64_t total) {
                                           progress.update("racing", "queries", done, total);
                                       });
    }
    if (config.k == info.k && result.queries == info.queries &&
        result.race.found_photons != info.found_photons)
        throw trace::DataError(fmt::format(
            "{}: found_photons: found {}, expected {}, which the searches find",
            (trace.folder() / "trace.json").string(), info.found_photons, result.race.found_photons));
    const std::vector<results::RaceRow> rows = rows_of(result);
    if (!options.csv.empty()) {
        results::write_csv<results::RaceRow>(options.csv, rows);
        results::write_provenance(options.csv, provenance(console, trace.checksum()), info.parameters);
    }
    console.print("{}", results::text_of(table_of(result, rows)));
    if (!options.csv.empty()) console.print("rows: {}\n", options.csv.string());
}

}  // namespace

void add_race(Command& command) {
    auto options = std::make_shared<Options>();
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
