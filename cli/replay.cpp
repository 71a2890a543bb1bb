// regather replay -- puts a trace's queries into orders and runs their walks through caches.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/machine.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "experiment/measurement.h"
#include "results/benefit.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "results/table.h"
#include "trace/error.h"
#include "trace/file.h"
#include "trace/size.h"

namespace regather::cli {
namespace {

/// The rows of cli/machine.h for each ordering, with its name before them.
std::string through_machines(const experiment::Measurement& measurement, const trace::TraceReader& trace,
                             std::span<const reorder::ParsedOrdering> orderings,
                             std::span<const cachesim::Machine> machines) {
    std::string text = "scene,ordering,parameters," + machine_header();
    Progress progress;
    for (const reorder::ParsedOrdering& parsed : orderings) {
        std::vector<cachesim::Hierarchy> systems;
        for (const cachesim::Machine& machine : machines) systems.push_back(machine.hierarchy());
        measurement.through(measurement.order(*parsed.ordering), systems, [&](std::uint64_t done) {
            progress.update("replaying " + parsed.spec.text, "queries", done, measurement.queries());
        });
        for (std::size_t m = 0; m < machines.size(); ++m) {
            const std::string rows = machine_rows(machines[m], systems[m]);
            for (std::size_t at = 0; at < rows.size();) {
                const std::size_t end = rows.find('\n', at) + 1;
                text += fmt::format("{},{},\"{}\",{}", trace.info().scene, parsed.spec.name, parsed.spec.text,
                                    rows.substr(at, end - at));
                at = end;
            }
        }
    }
    return text;
}

}  // namespace

void add_replay(CLI::App& app) {
    struct Options {
        std::filesystem::path trace, csv;
        std::vector<std::string> orders, caches{"128K:128:8"};
        std::string onchip = "1M", machines;
        bool classes = false, buffers = false, force = false;
        std::uint32_t one_of = 1;
        std::uint64_t seed = 1;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("replay", "run a trace's walks in other orders through caches");
    command->add_option("trace", options->trace, "the folder of a finished trace")->required();
    std::string known;
    for (const reorder::Entry& entry : reorder::catalogue())
        known += fmt::format("{}{}", known.empty() ? "" : ", ", entry.name);
    command
        ->add_option(
            "--order,--reorderer", options->orders,
            fmt::format("orderings as NAME:parameter=value,...; or the path of a shared library. Known: {}",
                        known))
        ->required();
    command
        ->add_option("--cache", options->caches,
                     "caches as SIZE:LINE:WAYS, each a value or a list; WAYS may be full")
        ->capture_default_str();
    command->add_option(
        "--machine", options->machines,
        "in place of --cache: memory systems, by name (see regather machines) or file, with commas");
    command->add_flag("--classes", options->classes, "compulsory, capacity and conflict misses, too");
    command->add_flag("--buffers", options->buffers,
                      "what the orderings' buffers add to the traffic when they do not fit --onchip, too; "
                      "one pass a cache");
    command
        ->add_option("--sample", options->one_of,
                     "simulate one set of so many (2, 4, ... 1024) and estimate; 1: all")
        ->capture_default_str();
    command->add_option("--seed", options->seed, "which sets are sampled")->capture_default_str();
    command->add_option("--onchip", options->onchip, "bytes that the chip can buffer")->capture_default_str();
    command->add_option("--csv", options->csv, "write the rows here, and X.json beside X.csv");
    command->add_flag("--force", options->force, "overwrite the CSV");
    command->footer(
        "Examples:\n"
        "  regather replay out/room/trace --order naive hilbert hilbert:tile=16 --cache 128K:128:8 --csv "
        "rows.csv\n"
        "  regather replay out/room/trace --reorderer ./libmine.so --cache 16K:64:full 1M:64:16");
    command->callback([options] {
        if (!options->csv.empty()) results::refuse_to_overwrite(options->csv, options->force);
        auto [orderings, reads] = experiment::parse_orderings(options->orders);
        std::vector<cachesim::CacheConfig> caches;
        for (const std::string& text : options->caches)
            for (const cachesim::CacheConfig& cache : experiment::parse_caches(text)) caches.push_back(cache);
        std::vector<std::uint32_t> lines;
        for (const cachesim::CacheConfig& cache : caches)
            if (std::find(lines.begin(), lines.end(), cache.line_bytes) == lines.end())
                lines.push_back(cache.line_bytes);
        experiment::Method method{options->classes, options->buffers, {}};
        if (options->one_of != 1) {
            if (options->classes || options->buffers)
                throw trace::UsageError(fmt::format("--{}: found beside --sample, expected one of them",
                                                    options->classes ? "classes" : "buffers"));
            method.sampling = replay::Sampling{options->one_of, options->seed};
            replay::SetSample::check(caches, *method.sampling);
        }
        std::vector<cachesim::Machine> machines;
        if (!options->machines.empty()) machines = load_machines(options->machines);
        trace::TraceReader trace(options->trace);
        experiment::Measurement measurement(trace, reads, trace::parse_size(options->onchip));
        if (!machines.empty()) {
            const std::string text = through_machines(measurement, trace, orderings, machines);
            if (options->csv.empty()) {
                fmt::print("{}", text);
                return;
            }
            trace::write_whole(options->csv, text);
            results::write_provenance(options->csv,
                                      {command_line(), version(), git_revision(), trace.checksum()},
                                      trace.info().parameters);
            fmt::print("rows: {}\n", options->csv.string());
            return;
        }
        measurement.find_compulsory(lines);
        std::vector<results::Row> rows;
        {
            Progress progress;
            measurement.prepare(caches, method, [&](std::uint64_t done) {
                progress.update("counting what no order changes", "queries", done, measurement.queries());
            });
            for (const reorder::ParsedOrdering& parsed : orderings) {
                const reorder::Ordered ordered = measurement.order(*parsed.ordering);
                const auto made = measurement.rows(parsed, ordered, caches, [&](std::uint64_t done) {
                    progress.update("replaying " + parsed.spec.text, "queries", done, measurement.queries());
                });
                rows.insert(rows.end(), made.begin(), made.end());
            }
        }
        results::fill_net_benefit(rows);
        if (options->csv.empty()) {
            fmt::print("{}", results::to_csv(rows));
            return;
        }
        results::write_csv(options->csv, rows);
        results::write_provenance(options->csv, {command_line(), version(), git_revision(), trace.checksum()},
                                  trace.info().parameters);
        fmt::print("{}rows: {}\n", results::table(rows), options->csv.string());
    });
}

}  // namespace regather::cli
