// regather run -- a whole experiment: capture, every ordering, every cache, CSV and charts. Finished parts
// are kept.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <xxhash.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <memory>
#include <set>

#include "charts/chart.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "experiment/capture_job.h"
#include "experiment/experiment.h"
#include "experiment/measurement.h"
#include "experiment/revisits.h"
#include "results/benefit.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "results/table.h"
#include "trace/error.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;

std::string method_text(const experiment::Method& method) {
    if (method.sampling) return fmt::format("1/{} seed {}", method.sampling->one_of, method.sampling->seed);
    return fmt::format("exact{}{}", method.classes ? " classes" : "", method.buffers ? " buffers" : "");
}

/// The rows of one trial, as a file that bears a digest of all that they depend on: the code, too.
fs::path part_path(const fs::path& folder, const experiment::Trial& trial, const trace::TraceReader& trace,
                   const experiment::Experiment& experiment) {
    std::string key =
        fmt::format("{} {} {} {} {} {}", git_revision(), trace.checksum(), trial.ordering.spec.text,
                    trial.library_digest, experiment.onchip_bytes, method_text(experiment.method));
    for (const cachesim::CacheConfig& cache : trial.caches) key += ' ' + experiment::cache_text(cache);
    return folder / "parts" / fmt::format("{:016x}.csv", XXH3_64bits(key.data(), key.size()));
}

std::string join(const std::vector<std::uint32_t>& numbers) {
    std::string text;
    for (const std::uint32_t number : numbers) text += (text.empty() ? "" : "-") + std::to_string(number);
    return text;
}

/// Compulsory traffic by line size, kept likewise.
void find_compulsory(experiment::Measurement& measurement, const fs::path& folder,
                     const experiment::Experiment& experiment, const trace::TraceReader& trace) {
    std::set<std::uint32_t> sizes;
    for (const experiment::Trial& trial : experiment.trials)
        for (const cachesim::CacheConfig& cache : trial.caches) sizes.insert(cache.line_bytes);
    const std::vector<std::uint32_t> lines(sizes.begin(), sizes.end());
    const fs::path path =
        folder / "parts" / fmt::format("compulsory-{}-{}.csv", trace.checksum(), join(lines));
    if (fs::exists(path)) {
        for (const results::Row& row : results::read_csv(path))
            measurement.compulsory_bytes[static_cast<std::uint32_t>(row.line_bytes.value_or(0))] =
                row.compulsory_bytes.value_or(0);
        return;
    }
    measurement.find_compulsory(lines);
    std::vector<results::Row> rows;
    for (const auto& [line, bytes] : measurement.compulsory_bytes) {
        results::Row row;
        row.scene = trace.info().scene;
        row.ordering = "any";
        row.line_bytes = line;
        row.compulsory_bytes = bytes;
        rows.push_back(row);
    }
    results::write_csv(path, rows);
}

/// What the replays of all trials share, kept likewise when it is exact.
void prepare(experiment::Measurement& measurement, const fs::path& folder,
             const experiment::Experiment& experiment, const trace::TraceReader& trace) {
    std::vector<cachesim::CacheConfig> caches;
    std::string key =
        fmt::format("{} {} {}", git_revision(), trace.checksum(), method_text(experiment.method));
    for (const experiment::Trial& trial : experiment.trials)
        for (const cachesim::CacheConfig& cache : trial.caches) {
            caches.push_back(cache);
            key += ' ' + experiment::cache_text(cache);
        }
    const fs::path path =
        folder / "parts" / fmt::format("revisits-{:016x}.json", XXH3_64bits(key.data(), key.size()));
    if (!experiment.method.sampling && fs::exists(path)) {
        const replay::Revisits revisits = experiment::read_revisits(path);
        if (!replay::serve(revisits, {caches, experiment.method.classes}))
            throw trace::DataError(
                fmt::format("{}: found counts of other caches, expected those of this experiment; delete it",
                            path.string()));
        measurement.prepare(revisits, experiment.method);
        return;
    }
    Progress progress;
    measurement.prepare(caches, experiment.method, [&](std::uint64_t done) {
        progress.update("counting what no order changes", "queries", done, measurement.queries());
    });
    if (!experiment.method.sampling) experiment::write_revisits(path, measurement.revisits());
}

/// Replays what is missing: as many trials at once as there are threads; their orders are made before, one by
/// one, so that order_seconds is measured on a machine that does nothing else.
void replay_missing(const experiment::Measurement& measurement, const experiment::Experiment& experiment,
                    std::span<const fs::path> parts) {
    std::vector<std::size_t> missing;
    std::set<fs::path> seen;  // a trial that is asked for twice is replayed once
    for (std::size_t t = 0; t < parts.size(); ++t)
        if (!fs::exists(parts[t]) && seen.insert(parts[t]).second) missing.push_back(t);
    const std::uint64_t total = missing.size() * measurement.queries();
    std::atomic<std::uint64_t> done{0};
    Progress progress;
    constexpr std::uint64_t most_bytes = std::uint64_t{4}
                                         << 30;  // of permutations held: 4 bytes a query each
    const std::uint64_t fitting = most_bytes / (4 * std::max<std::uint64_t>(measurement.queries(), 1));
    const auto threads = static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency());
    const std::size_t at_once = std::clamp<std::uint64_t>(fitting, 1, threads);
    for (std::size_t first = 0; first < missing.size(); first += at_once) {
        const std::size_t count = std::min(at_once, missing.size() - first);
        std::vector<reorder::Ordered> ordered;
        for (std::size_t i = 0; i < count; ++i) {
            const experiment::Trial& trial = experiment.trials[missing[first + i]];
            progress.update(fmt::format("replaying {} orderings", missing.size()), "queries", done, total);
            ordered.push_back(measurement.order(*trial.ordering.ordering));
        }
        tbb::task_group replays;
        for (std::size_t i = 0; i < count; ++i)
            replays.run([&, i] {
                const std::size_t t = missing[first + i];
                const experiment::Trial& trial = experiment.trials[t];
                std::uint64_t before = 0;
                const auto rows =
                    measurement.rows(trial.ordering, ordered[i], trial.caches, [&](std::uint64_t now) {
                        const std::uint64_t all = done += now - before;
                        before = now;
                        progress.update(fmt::format("replaying {} orderings", missing.size()), "queries", all,
                                        total);
                    });
                results::write_csv(parts[t], rows);
            });
        replays.wait();
    }
}

/// All rows of one trace: what is missing is replayed.
std::vector<results::Row> measured(trace::TraceReader& trace, const fs::path& folder,
                                   const experiment::Experiment& experiment) {
    experiment::Measurement measurement(trace, experiment::reads(experiment), experiment.onchip_bytes);
    fs::create_directories(folder / "parts");
    find_compulsory(measurement, folder, experiment, trace);
    std::vector<fs::path> parts;
    for (const experiment::Trial& trial : experiment.trials)
        parts.push_back(part_path(folder, trial, trace, experiment));
    if (!std::all_of(parts.begin(), parts.end(), [](const fs::path& part) { return fs::exists(part); })) {
        prepare(measurement, folder, experiment, trace);
        replay_missing(measurement, experiment, parts);
    }
    std::vector<results::Row> rows;
    for (std::size_t t = 0; t < parts.size(); ++t) {
        const std::vector<results::Row> some = results::read_csv(parts[t]);
        if (some.size() != experiment.trials[t].caches.size())
            throw trace::DataError(fmt::format("{}: found {} rows, expected {}, one a cache; delete it",
                                               parts[t].string(), some.size(),
                                               experiment.trials[t].caches.size()));
        rows.insert(rows.end(), some.begin(), some.end());
    }
    return rows;
}

}  // namespace

void add_run(CLI::App& app) {
    struct Options {
        fs::path experiment, folder;
        bool force = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("run", "capture, reorder, replay and chart what an experiment file asks for");
    command->add_option("experiment", options->experiment, "a JSON file; see docs/experiments.md")
        ->required();
    command->add_option("-o,--output", options->folder, "folder for everything that is made")->required();
    command->add_flag("--force", options->force, "capture again although the folder holds another capture");
    command->footer(
        "Finished parts in the folder are kept: the same command goes on after an interruption.\n"
        "Example:\n  regather run scenes/experiments/figure4.json -o out/figure4");
    command->callback([options] {
        const experiment::Experiment experiment = experiment::load_experiment(options->experiment);
        experiment::CaptureResult captured;
        {
            Progress progress;
            captured = experiment::run({experiment.scene, experiment.capture, experiment::reads(experiment),
                                        options->folder, options->force},
                                       progress.listener());
        }
        fmt::print("{}", captured.report);
        std::fflush(stdout);

        std::vector<results::Row> rows;
        std::vector<std::string> checksums;
        nlohmann::json parameters;
        for (const fs::path& folder : captured.folders) {
            trace::TraceReader trace(folder / "trace");
            for (results::Row& row : measured(trace, folder, experiment)) rows.push_back(std::move(row));
            checksums.push_back(trace.checksum());
            parameters = trace.info().parameters;
        }
        if (captured.folders.size() > 1) parameters["frame"] = experiment.capture.frames;
        results::fill_net_benefit(rows);
        const fs::path csv = options->folder / "rows.csv";
        results::write_csv(csv, rows);
        results::write_provenance(
            csv, {command_line(), version(), git_revision(), fmt::format("{}", fmt::join(checksums, " "))},
            parameters);
        const auto charts = charts::write_charts(options->folder / "charts", rows, {}, {});
        fmt::print("{}", results::table(rows));
        for (const fs::path& folder : captured.folders)
            fmt::print("image:  {}\n", (folder / "image.png").string());
        fmt::print("rows:   {}\n", csv.string());
        for (const charts::Drawn& drawn : charts) {
            if (drawn.files.empty()) {
                fmt::print("chart:  no {}: {}\n", drawn.kind, drawn.skipped);
            } else {
                for (const fs::path& file : drawn.files) fmt::print("chart:  {}\n", file.string());
            }
        }
    });
}

}  // namespace regather::cli
