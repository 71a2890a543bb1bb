// regather detail -- one cache, told apart: which data missed, why, how much of what was fetched was used,
// and when.
#include "experiment/detail.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "results/csv.h"
#include "results/geometry.h"
#include "results/provenance.h"
#include "trace/error.h"
#include "trace/size.h"

namespace regather::cli {
namespace {

struct Options {
    std::filesystem::path trace, csv, timeline;
    std::vector<std::string> orders, caches{"128K:128:8"};
    std::string onchip = "1M";
    std::uint64_t slices = 200;
    bool no_buffers = false, force = false;
};

/// Before anything is computed. Looks at the provenance beside each CSV, too.
void check_outputs(const Options& options) {
    std::vector<std::filesystem::path> files;
    for (const auto& [option, csv] : {std::pair{"--csv", options.csv}, {"--timeline", options.timeline}}) {
        if (csv.empty()) continue;
        const std::filesystem::path json = results::provenance_path(csv);
        if (json == csv)
            throw trace::UsageError(fmt::format(
                "{}: found {}, expected another ending than .json, which the provenance beside it bears",
                option, csv.string()));
        files.push_back(csv);
        files.push_back(json);
    }
    if (files.size() == 4 && files[1] == files[3])
        throw trace::UsageError(
            fmt::format("--timeline: found {}, expected another name than that of --csv, for the "
                        "provenance beside it",
                        options.timeline.string()));
    if (options.force) return;
    for (const std::filesystem::path& file : files)
        if (std::filesystem::exists(file))
            throw trace::UsageError(fmt::format("{}: exists; --force overwrites it", file.string()));
}

template <class R>
void write(const std::filesystem::path& csv, const std::vector<R>& rows, const trace::TraceReader& trace) {
    if (csv.empty()) return;
    results::write_csv<R>(csv, rows);
    results::write_provenance(csv, {command_line(), version(), git_revision(), trace.checksum()},
                              trace.info().parameters);
}

void run(const Options& options) {
    check_outputs(options);
    const auto [orderings, reads] = experiment::parse_orderings(options.orders);
    std::vector<cachesim::CacheConfig> caches;
    for (const std::string& text : options.caches)
        for (const cachesim::CacheConfig& cache : experiment::parse_caches(text)) caches.push_back(cache);
    const std::uint64_t onchip = trace::parse_size(options.onchip);
    trace::TraceReader trace(options.trace);
    const experiment::Measurement measurement(trace, reads, onchip);
    const std::string& scene = trace.info().scene;
    experiment::Detail detail;
    {
        Progress progress;
        detail =
            experiment::detail(measurement, scene, {orderings, caches, options.slices, !options.no_buffers},
                               progress.listener());
    }
    write(options.csv, detail.rows, trace);
    write(options.timeline, detail.slices, trace);
    for (std::size_t c = 0; c < caches.size(); ++c)
        fmt::print("{}{} | {} queries | {} | on chip {}\n{}", c == 0 ? "" : "\n", scene,
                   results::decimal_count(static_cast<double>(measurement.queries())),
                   experiment::cache_text(caches[c]), options.onchip,
                   experiment::detail_table(detail.lines[c]));
    fmt::print(
        "traffic = fetched and written back; overfetch = traffic / bytes used; 3C = compulsory / capacity / "
        "conflict misses\n");
    if (detail.unknown_buffers)
        fmt::print("a library's buffers are not simulated: how they are used is not known\n");
    if (!options.csv.empty()) fmt::print("rows: {}\n", options.csv.string());
    if (!options.timeline.empty()) fmt::print("timeline: {}\n", options.timeline.string());
}

}  // namespace

void add_detail(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("detail", "tell apart which data misses in a cache, why, and when");
    command->add_option("trace", options->trace, "the folder of a finished trace")->required();
    command
        ->add_option("--order,--reorderer", options->orders,
                     "orderings as NAME:parameter=value,...; or the path of a shared library")
        ->required();
    command->add_option("--cache", options->caches, "caches as SIZE:LINE:WAYS; WAYS may be full")
        ->capture_default_str();
    command->add_option("--onchip", options->onchip, "bytes that the chip can buffer")->capture_default_str();
    command->add_option("--slices", options->slices, "slices of the run in the timeline")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 32))
        ->capture_default_str();
    command->add_flag("--no-buffers", options->no_buffers, "leave out the accesses of reorder buffers");
    command->add_option("--csv", options->csv,
                        "write rows by region and tree depth here, and X.json beside X.csv");
    command->add_option("--timeline", options->timeline, "write rows by slice of the run here, likewise");
    command->add_flag("--force", options->force, "overwrite the files");
    command->footer(
        "Example:\n"
        "  regather detail out/room/trace --order naive hilbert hilbert:tile=16 --csv detail.csv --timeline "
        "timeline.csv");
    command->callback([options] { run(*options); });
}

}  // namespace regather::cli
