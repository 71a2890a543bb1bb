// regather sampling -- how far off are sampled replays, and how much faster? Error against run time, measured
// on a trace.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "charts/accuracy.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "experiment/measurement.h"
#include "results/csv.h"
#include "results/provenance.h"

namespace regather::cli {
namespace {

struct Options {
    std::filesystem::path trace, csv;
    std::vector<std::string> orders{"naive", "hilbert"}, caches{"128K:128:8"};
    std::vector<std::uint32_t> rates{2, 4, 8, 16};
    std::uint64_t seeds = 4;
    bool force = false;
};

void run(const Options& options) {
    if (!options.csv.empty()) results::refuse_to_overwrite(options.csv, options.force);
    auto [orderings, reads] = experiment::parse_orderings(options.orders);
    std::vector<cachesim::CacheConfig> caches;
    for (const std::string& text : options.caches)
        for (const cachesim::CacheConfig& cache : experiment::parse_caches(text)) caches.push_back(cache);
    for (const std::uint32_t rate : options.rates) replay::SetSample::check(caches, {rate, 1});

    trace::TraceReader trace(options.trace);
    experiment::Measurement exact(trace, reads, reorder::default_onchip_bytes),
        sampled(trace, reads, reorder::default_onchip_bytes);
    Progress progress;
    const auto shared = [&](std::uint64_t done) {
        progress.update("counting what no order changes", "queries", done, exact.queries());
    };
    exact.prepare(caches, {}, shared);
    sampled.prepare(caches, {.sampling = replay::Sampling{options.rates.front(), 1}}, shared);

    std::vector<results::SamplingRow> rows;
    for (const reorder::ParsedOrdering& parsed : orderings) {
        const reorder::Ordered ordered = exact.order(*parsed.ordering);
        const auto replaying = [&](const std::string& what) {
            return [&progress, &exact, text = "replaying " + parsed.spec.text + what](std::uint64_t done) {
                progress.update(text, "queries", done, exact.queries());
            };
        };
        const auto truth = exact.rows(parsed, ordered, caches, replaying(""));
        for (const std::uint32_t rate : options.rates)
            for (std::uint64_t seed = 1; seed <= options.seeds; ++seed) {
                sampled.sample({rate, seed});
                const auto found =
                    sampled.rows(parsed, ordered, caches, replaying(fmt::format(", 1/{}", rate)));
                for (std::size_t c = 0; c < caches.size(); ++c) {
                    const results::Row &row = found[c], &exactly = truth[c];
                    rows.push_back(
                        {.scene = row.scene,
                         .ordering = row.ordering,
                         .parameters = row.parameters,
                         .cache_bytes = row.cache_bytes,
                         .line_bytes = row.line_bytes,
                         .ways = row.ways,
                         .set_sampling = row.set_sampling,
                         .seed = seed,
                         .misses = row.misses,
                         .misses_stderr = row.misses_stderr,
                         .misses_low = row.misses_low,
                         .misses_high = row.misses_high,
                         .exact_misses = exactly.misses,
                         .covered = *row.misses_low <= *exactly.misses && *exactly.misses <= *row.misses_high,
                         .seconds = row.replay_seconds,
                         .exact_seconds = exactly.replay_seconds});
                }
            }
    }
    if (options.csv.empty()) {
        fmt::print("{}", results::to_csv<results::SamplingRow>(rows));
        return;
    }
    results::write_csv<results::SamplingRow>(options.csv, rows);
    results::write_provenance(options.csv, {command_line(), version(), git_revision(), trace.checksum()},
                              trace.info().parameters);
    fmt::print("{}rows: {}\n", charts::accuracy_table(rows), options.csv.string());
}

}  // namespace

void add_sampling(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "sampling", "measure the error and the speed of set sampling against exact replays");
    command->add_option("trace", options->trace, "the folder of a finished trace")->required();
    command->add_option("--order", options->orders, "orderings, as for replay")->capture_default_str();
    command->add_option("--cache", options->caches, "caches, as for replay")->capture_default_str();
    command->add_option("--rates", options->rates, "one set of so many: 2, 4, ... 1024")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--seeds", options->seeds, "samples taken at each rate")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--csv", options->csv, "write the rows here, and X.json beside X.csv");
    command->add_flag("--force", options->force, "overwrite the CSV");
    command->footer(
        "Example:\n  regather sampling out/room/trace --order naive hilbert --cache 16K,128K:128:1 --rates "
        "2,4,8,16,32 "
        "--csv sampling.csv\n  regather chart sampling.csv -o charts");
    command->callback([options] { run(*options); });
}

}  // namespace regather::cli
