// regather sampling -- how far off are sampled replays, and how much faster? Error against run time, measured
// on a trace.
#include "experiment/sampling.h"

#include <filesystem>
#include <memory>

#include "cachesim/cache_list.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "results/accuracy.h"
#include "results/csv.h"
#include "results/provenance.h"

namespace regather::cli {
namespace {

struct SamplingOptions {
    std::filesystem::path trace, csv;
    std::vector<std::string> orders{"naive", "hilbert"}, caches{"128K:128:8"};
    std::vector<std::uint32_t> rates{2, 4, 8, 16};
    std::uint64_t seeds = 4;
    bool force = false;
};

void measure_sampling(const SamplingOptions& options, const Console& console) {
    if (!options.csv.empty()) results::refuse_to_overwrite(options.csv, options.force);
    const experiment::Orderings orderings = experiment::parse_orderings(options.orders);
    const auto caches = cachesim::parse_caches(options.caches);
    trace::TraceReader trace(options.trace);
    const auto rows = experiment::sampling(trace, {orderings, caches, options.rates, options.seeds},
                                           Progress(console).listener());
    if (options.csv.empty()) return console.print("{}", results::to_csv<results::SamplingRow>(rows));
    results::write_csv<results::SamplingRow>(options.csv, rows);
    results::write_provenance(options.csv, provenance(console, trace.checksum()), trace.info().parameters);
    console.print("{}rows: {}\n", results::text_of(results::accuracy_table(rows)), options.csv.string());
}

}  // namespace

void add_sampling(Command& command) {
    auto options = std::make_shared<SamplingOptions>();
    command.argument("trace", options->trace, "the folder of a finished trace").required();
    command.list("--order,--reorderer", options->orders, "orderings, as for replay");
    command.list("--cache", options->caches, "caches, as for replay");
    command.comma_list("--rates", options->rates, {1, 1024}, "one set of so many: 2, 4, ... 1024");
    command.option("--seeds", options->seeds, {1, 1000}, "samples taken at each rate");
    command.option("--csv", options->csv, "write the rows here, and X.json beside X.csv");
    command.flag("--force", options->force, "overwrite the CSV");
    command.needs("--force", {"--csv"});
    command.footer(
        "Example:\n  regather sampling out/room/trace --order naive hilbert --cache 16K,128K:128:1 --rates "
        "2,4,8,16,32 --csv sampling.csv\n  regather chart sampling.csv -o charts");
    command.action(options, measure_sampling);
}

}  // namespace regather::cli
