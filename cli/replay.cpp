// regather replay -- puts a trace's queries into orders and runs their walks through caches.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <set>

#include "cachesim/cache_list.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "experiment/address_sweep.h"
#include "experiment/measurement.h"
#include "results/benefit.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "results/traffic_table.h"
#include "trace/error.h"
#include "trace/size.h"

namespace regather::cli {
namespace {

/// The rows of machines for each ordering, with its name.
std::vector<results::MachineRow> through_machines(const experiment::Measurement& measurement,
                                                  const trace::TraceReader& trace,
                                                  std::span<const reorder::ParsedOrdering> orderings,
                                                  std::span<const cachesim::Machine> machines,
                                                  const Console& console) {
    std::vector<results::MachineRow> rows;
    Progress progress(console);
    for (const reorder::ParsedOrdering& parsed : orderings) {
        std::vector<cachesim::Hierarchy> systems;
        for (const cachesim::Machine& machine : machines) systems.push_back(machine.hierarchy());
        measurement.through(measurement.order(*parsed.ordering), systems, [&](std::uint64_t done) {
            progress.update("replaying " + parsed.spec.text, "queries", done, measurement.queries());
        });
        for (std::size_t m = 0; m < machines.size(); ++m)
            for (results::MachineRow& row : experiment::machine_rows(machines[m], systems[m])) {
                row.scene = trace.info().scene;
                row.ordering = parsed.spec.name;
                row.parameters = parsed.spec.text;
                rows.push_back(std::move(row));
            }
    }
    return rows;
}

struct Options {
    std::filesystem::path trace, csv;
    std::vector<std::string> orders, caches{"128K:128:8"};
    std::string onchip = "1M", machines;
    bool classes = false, buffers = false, force = false;
    std::uint32_t one_of = 1;
    std::uint64_t seed = 1;
};

/// Every ordering through every cache.
std::vector<results::Row> through_caches(experiment::Measurement& measurement,
                                         std::span<const reorder::ParsedOrdering> orderings,
                                         std::span<const cachesim::CacheConfig> caches,
                                         const experiment::Method& method, const Console& console) {
    Progress progress(console);
    const experiment::ProgressListener listener = progress.listener();
    std::set<std::uint32_t> lines;
    for (const cachesim::CacheConfig& cache : caches) lines.insert(cache.line_bytes);
    measurement.find_compulsory(std::vector<std::uint32_t>(lines.begin(), lines.end()));
    measurement.prepare(
        caches, method,
        experiment::listening(listener, "counting what no order changes", "queries", measurement.queries()));
    std::vector<results::Row> rows;
    for (const reorder::ParsedOrdering& parsed : orderings)
        for (results::Row& row :
             measurement.rows(parsed, measurement.order(*parsed.ordering), caches,
                              experiment::listening(listener, "replaying " + parsed.spec.text, "queries",
                                                    measurement.queries())))
            rows.push_back(std::move(row));
    results::fill_net_benefit(rows);
    return rows;
}

void run(const Options& options, const Console& console) {
    if (!options.csv.empty()) results::refuse_to_overwrite(options.csv, options.force);
    const auto [orderings, reads] = experiment::parse_orderings(options.orders);
    const auto caches = cachesim::parse_caches(options.caches);
    experiment::Method method{options.classes, options.buffers, {}};
    if (options.one_of != 1) {
        method.sampling = replay::Sampling{options.one_of, options.seed};
        replay::SetSample::check(caches, *method.sampling);
    }
    std::vector<cachesim::Machine> machines;
    if (!options.machines.empty()) machines = experiment::load_machines(options.machines);
    trace::TraceReader trace(options.trace);
    experiment::Measurement measurement(trace, reads, trace::parse_size(options.onchip));
    std::string csv, table;
    if (machines.empty()) {
        const std::vector<results::Row> rows =
            through_caches(measurement, orderings, caches, method, console);
        csv = results::to_csv(rows);
        table = results::traffic_text(rows);
    } else {
        const auto rows = through_machines(measurement, trace, orderings, machines, console);
        csv = results::to_csv<results::MachineRow>(rows);
        table = results::text_of(results::table_of<results::MachineRow>(rows));
    }
    if (options.csv.empty()) return console.print("{}", csv);
    results::write_csv(options.csv, csv);
    results::write_provenance(options.csv, provenance(console, trace.checksum()), trace.info().parameters);
    console.print("{}rows: {}\n", table, options.csv.string());
}

}  // namespace

void add_replay(Command& command) {
    auto options = std::make_shared<Options>();
    command.argument("trace", options->trace, "the folder of a finished trace").required();
    std::string known;
    for (const reorder::Entry& entry : reorder::catalogue())
        known += fmt::format("{}{}", known.empty() ? "" : ", ", entry.name);
    command
        .list("--order,--reorderer", options->orders,
              fmt::format("orderings as NAME:parameter=value,...; or the path of a shared library. Known: {}",
                          known))
        .required();
    command.list("--cache", options->caches,
                 "caches as SIZE:LINE:WAYS, each a value or a list; WAYS may be full");
    command.option(
        "--machine", options->machines,
        "in place of --cache: memory systems, by name (see regather machines) or file, with commas");
    command.flag("--classes", options->classes, "compulsory, capacity and conflict misses, too");
    command.flag("--buffers", options->buffers,
                 "what the orderings' buffers add to the traffic when they do not fit --onchip, too; one "
                 "pass a cache");
    command.option("--sample", options->one_of, {1, 1024},
                   "simulate one set of so many (2, 4, ... 1024) and estimate; 1: all");
    command.option("--seed", options->seed, {}, "which sets are sampled");
    command.option("--onchip", options->onchip, "bytes that the chip can buffer");
    command.option("--csv", options->csv, "write the rows here, and X.json beside X.csv");
    command.flag("--force", options->force, "overwrite the CSV");
    command.conflict("--machine", {"--cache", "--classes", "--buffers", "--sample", "--seed"});
    command.conflict("--sample", {"--classes", "--buffers"});
    command.needs("--seed", {"--sample"});
    command.needs("--force", {"--csv"});
    command.footer(
        "Examples:\n"
        "  regather replay out/room/trace --order naive hilbert hilbert:tile=16 --cache 128K:128:8 --csv "
        "rows.csv\n"
        "  regather replay out/room/trace --reorderer ./libmine.so --cache 16K:64:full 1M:64:16");
    command.action(options, run);
}

}  // namespace regather::cli
