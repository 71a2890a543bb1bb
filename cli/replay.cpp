// regather replay -- puts a trace's queries into orders and runs their walks through caches.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/measurement.h"
#include "cli/progress.h"
#include "cli/size.h"
#include "cli/version.h"
#include "results/benefit.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "results/table.h"
#include "trace/error.h"

namespace regather::cli {
namespace {

/// Looks at the provenance beside the CSV, too: somebody's X.json is not ours to replace.
void refuse_to_overwrite(const std::filesystem::path& csv, bool force) {
    const std::filesystem::path json = results::provenance_path(csv);
    if (json == csv)
        throw trace::UsageError(fmt::format("--csv: found {}, expected another ending than .json, which the provenance "
                                            "beside it bears", csv.string()));
    if (force) return;
    for (const std::filesystem::path& file : {csv, json})
        if (std::filesystem::exists(file))
            throw trace::UsageError(fmt::format("{}: exists; --force overwrites it", file.string()));
}

}  // namespace

void add_replay(CLI::App& app) {
    struct Options {
        std::filesystem::path trace, csv;
        std::vector<std::string> orders, caches{"128K:128:8"};
        std::string onchip = "1M";
        bool classes = false, force = false;
        std::uint32_t one_of = 1;
        std::uint64_t seed = 1;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("replay", "run a trace's walks in other orders through caches");
    command->add_option("trace", options->trace, "the folder of a finished trace")->required();
    std::string known;
    for (const reorder::Entry& entry : reorder::catalogue()) known += fmt::format("{}{}", known.empty() ? "" : ", ", entry.name);
    command
        ->add_option("--order,--reorderer", options->orders,
                     fmt::format("orderings as NAME:parameter=value,...; or the path of a shared library. Known: {}", known))
        ->required();
    command->add_option("--cache", options->caches, "caches as SIZE:LINE:WAYS, each a value or a list; WAYS may be full")->capture_default_str();
    command->add_flag("--classes", options->classes, "compulsory, capacity and conflict misses, too");
    command->add_option("--sample", options->one_of, "simulate one set of so many (2, 4, ... 1024) and estimate; 1: all")->capture_default_str();
    command->add_option("--seed", options->seed, "which sets are sampled")->capture_default_str();
    command->add_option("--onchip", options->onchip, "bytes that the chip can buffer")->capture_default_str();
    command->add_option("--csv", options->csv, "write the rows here, and X.json beside X.csv");
    command->add_flag("--force", options->force, "overwrite the CSV");
    command->footer("Examples:\n"
                    "  regather replay out/room/trace --order naive hilbert hilbert:tile=16 --cache 128K:128:8 --csv rows.csv\n"
                    "  regather replay out/room/trace --reorderer ./libmine.so --cache 16K:64:full 1M:64:16");
    command->callback([options] {
        if (!options->csv.empty()) refuse_to_overwrite(options->csv, options->force);
        std::vector<reorder::ParsedOrdering> orderings;
        reorder::Reads reads;
        for (const std::string& spec : options->orders) {
            orderings.push_back(reorder::parse_ordering(spec));
            const reorder::Reads one = orderings.back().ordering->reads();
            reads = {reads.direction || one.direction, reads.leaf_kd || one.leaf_kd, reads.leaf_bvh || one.leaf_bvh};
        }
        std::vector<cachesim::CacheConfig> caches;
        for (const std::string& text : options->caches)
            for (const cachesim::CacheConfig& cache : parse_caches(text)) caches.push_back(cache);
        std::vector<std::uint32_t> lines;
        for (const cachesim::CacheConfig& cache : caches)
            if (std::find(lines.begin(), lines.end(), cache.line_bytes) == lines.end()) lines.push_back(cache.line_bytes);
        Method method{options->classes, {}};
        if (options->one_of != 1) {
            if (options->classes) throw trace::UsageError("--classes: found beside --sample, expected one of them");
            method.sampling = replay::Sampling{options->one_of, options->seed};
            replay::SetSample::check(caches, *method.sampling);
        }
        trace::TraceReader trace(options->trace);
        Measurement measurement(trace, reads, parse_size(options->onchip));
        measurement.find_compulsory(lines);
        std::vector<results::Row> rows;
        {
            Progress progress;
            measurement.prepare(caches, method, [&](std::uint64_t done) {
                progress.update("counting what no order changes", "queries", done, measurement.queries());
            });
            for (const reorder::ParsedOrdering& parsed : orderings) {
                const reorder::Ordered ordered = measurement.order(*parsed.ordering);
                const auto made = measurement.rows(parsed.spec, ordered, caches, [&](std::uint64_t done) {
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
        results::write_provenance(options->csv,
                                  {command_line(), version(), git_revision(), trace.checksum()}, trace.info().parameters);
        fmt::print("{}rows: {}\n", results::table(rows), options->csv.string());
    });
}

}  // namespace regather::cli
