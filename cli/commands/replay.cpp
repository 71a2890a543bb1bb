// regather replay -- puts a trace's queries into orders and runs their walks through caches.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cachesim/cache_list.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "experiment/address_sweep.h"
#include "experiment/replays.h"
#include "experiment/treelet_replay.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "results/traffic_table.h"
#include "trace/error.h"
#include "trace/size.h"

namespace regather::cli {
namespace {

struct ReplayOptions {
    std::filesystem::path trace, csv;
    std::vector<std::string> orders, caches{"128K:128:8"}, layouts;
    std::string onchip = "1M", machines;
    bool classes = false, buffers = false, force = false;
    std::uint32_t one_of = 1;
    std::uint64_t seed = 1;
    std::vector<std::string> treelets;
    std::vector<std::uint32_t> queued;
};

void replay_trace(const ReplayOptions& options, const Console& console) {
    if (!options.csv.empty()) results::refuse_to_overwrite(options.csv, options.force);
    const auto [orderings, reads] = experiment::parse_orderings(options.orders);
    const auto caches = cachesim::parse_caches(options.caches);
    experiment::Method method{
        .classes = options.classes, .buffers = options.buffers, .several_orders = false, .sampling = {}};
    if (options.one_of != 1) {
        method.sampling = replay::Sampling{options.one_of, options.seed};
        replay::SetSample::check(caches, *method.sampling);
    }
    std::vector<cachesim::Machine> machines;
    if (!options.machines.empty()) machines = experiment::load_machines(options.machines);
    const auto treelets = experiment::treelet_configs(options.treelets, options.queued);
    trace::TraceReader trace(options.trace);
    experiment::Measurement measurement(trace, reads, trace::parse_size(options.onchip));
    const experiment::Replays replays{options.layouts, orderings, treelets};
    std::string csv, table;
    Progress progress(console);
    if (machines.empty()) {
        const auto rows =
            experiment::through_caches(measurement, replays, caches, method, progress.listener());
        csv = results::to_csv(rows);
        table = results::traffic_text(rows);
    } else {
        const auto rows = experiment::through_machines(measurement, replays, machines, progress.listener());
        csv = results::to_csv<results::MachineRow>(rows);
        table = results::text_of(results::table_of<results::MachineRow>(rows));
    }
    progress.clear();
    if (options.csv.empty()) return console.print("{}", csv);
    results::write_csv(options.csv, csv);
    results::write_provenance(options.csv, provenance(console, trace.checksum()), trace.info().parameters);
    console.print("{}rows: {}\n", table, options.csv.string());
}

}  // namespace

void add_replay(Command& command) {
    auto options = std::make_shared<ReplayOptions>();
    command.argument("trace", options->trace, "the folder of a finished trace").required();
    std::string known;
    for (const reorder::Entry& entry : reorder::catalogue())
        known += fmt::format("{}{}", known.empty() ? "" : ", ", entry.name);
    command
        .list("--order,--reorderer", options->orders,
              fmt::format("orderings as NAME:parameter=value,...; file:KEYS.npy; or the path of a shared "
                          "library. Known: "
                          "{}",
                          known))
        .required();
    command.list("--cache", options->caches,
                 "caches as SIZE:LINE:WAYS, each a value or a list; WAYS may be full");
    command.list(
        "--layout", options->layouts,
        "where each node lies in memory, as ORDER-RECORD:parameter=value,...; see regather layouts. heap-20, "
        "for rays depth-first-48, of brought walks heap-own or, with addresses, given-own");
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
    command.comma_list("--treelets", options->treelets,
                       "of rays: each ordering also feeds queues at treelets of so many bytes, in rows of "
                       "their own, ORDERING+treelets");
    command.comma_list("--queue", options->queued, {1, replay::most_queued_rays},
                       "rays under way in those queues at most");
    command.option("--onchip", options->onchip, "bytes that the chip can buffer");
    command.option("--csv", options->csv, "write the rows here, and X.json beside X.csv");
    command.flag("--force", options->force, "overwrite the CSV");
    command.conflict("--machine", {"--cache", "--classes", "--buffers", "--sample", "--seed"});
    command.conflict("--sample", {"--classes", "--buffers"});
    command.conflict("--treelets", {"--classes", "--sample"});
    command.needs("--treelets", {"--queue"});
    command.needs("--queue", {"--treelets"});
    command.needs("--seed", {"--sample"});
    command.needs("--force", {"--csv"});
    command.footer(
        "Examples:\n"
        "  regather replay out/room/trace --order naive hilbert hilbert:tile=16 --cache 128K:128:8 --csv "
        "rows.csv\n"
        "  regather replay out/room/trace --reorderer ./libmine.so --cache 16K:64:full 1M:64:16");
    command.action(options, replay_trace);
}

}  // namespace regather::cli
