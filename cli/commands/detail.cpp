// regather detail -- one cache, told apart: which data missed, why, how much of what was fetched was used,
// and when.
#include "experiment/detail.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cachesim/cache_list.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "results/csv.h"
#include "results/geometry.h"
#include "results/provenance.h"
#include "trace/size.h"
#include "trace/text.h"

namespace regather::cli {
namespace {

struct DetailOptions {
    std::filesystem::path trace, csv, timeline;
    std::vector<std::string> orders, caches{"128K:128:8"};
    std::string onchip = "1M", layout;
    std::uint64_t slices = 200;
    bool no_buffers = false, force = false;
};

template <class R>
void write(const std::filesystem::path& csv, const std::vector<R>& rows, const trace::TraceReader& trace,
           const Console& console) {
    if (csv.empty()) return;
    results::write_csv<R>(csv, rows);
    results::write_provenance(csv, provenance(console, trace.checksum()), trace.info().parameters);
}

void tell_detail(const DetailOptions& options, const Console& console) {
    const results::Output outputs[] = {{"--csv", options.csv}, {"--timeline", options.timeline}};
    results::refuse_to_overwrite(outputs, options.force);
    const auto [orderings, reads] = experiment::parse_orderings(options.orders);
    const auto caches = cachesim::parse_caches(options.caches);
    const std::uint64_t onchip = trace::parse_size(options.onchip);
    trace::TraceReader trace(options.trace);
    experiment::Measurement measurement(trace, reads, onchip);
    if (!options.layout.empty()) measurement.lay_out(options.layout);
    const std::string& scene = trace.info().scene;
    experiment::Detail detail;
    {
        Progress progress(console);
        detail =
            experiment::detail(measurement, scene, {orderings, caches, options.slices, !options.no_buffers},
                               progress.listener());
    }
    write(options.csv, detail.rows, trace, console);
    write(options.timeline, detail.slices, trace, console);
    for (std::size_t c = 0; c < caches.size(); ++c)
        console.print("{}{} | {} queries | {} | {} | on chip {}\n{}", c == 0 ? "" : "\n", trace::shown(scene),
                      results::decimal_count(static_cast<double>(measurement.queries())),
                      measurement.layout().name(), cachesim::cache_text(caches[c]), options.onchip,
                      results::text_of(experiment::detail_table(detail.lines[c])));
    console.print(
        "structure = what was searched; traffic = fetched and written back; overfetch = traffic / bytes "
        "used; 3C = compulsory / capacity / "
        "conflict misses\n");
    if (detail.unknown_buffers)
        console.print("a library's buffers are not simulated: how they are used is not known\n");
    if (!options.csv.empty()) console.print("rows: {}\n", options.csv.string());
    if (!options.timeline.empty()) console.print("timeline: {}\n", options.timeline.string());
}

}  // namespace

void add_detail(Command& command) {
    auto options = std::make_shared<DetailOptions>();
    command.argument("trace", options->trace, "the folder of a finished trace").required();
    command
        .list("--order,--reorderer", options->orders,
              "orderings as NAME:parameter=value,...; file:KEYS.npy; or the path of a shared library")
        .required();
    command.list("--cache", options->caches, "caches as SIZE:LINE:WAYS; WAYS may be full");
    command.option(
        "--layout", options->layout,
        "where each node lies in memory, as ORDER-RECORD:parameter=value,...; see regather layouts. Without: "
        "heap-20, for rays depth-first-48");
    command.option("--onchip", options->onchip, "bytes that the chip can buffer");
    command.option("--slices", options->slices, {1, std::uint64_t{1} << 32},
                   "slices of the run in the timeline");
    command.flag("--no-buffers", options->no_buffers, "leave out the accesses of reorder buffers");
    command.option("--csv", options->csv,
                   "write rows by region and tree depth here, and X.json beside X.csv");
    command.option("--timeline", options->timeline, "write rows by slice of the run here, likewise");
    command.flag("--force", options->force, "overwrite the files");
    command.needs("--slices", {"--timeline"});
    command.needs("--force", {"--csv", "--timeline"});
    command.footer(
        "Example:\n"
        "  regather detail out/room/trace --order naive hilbert hilbert:tile=16 --csv detail.csv --timeline "
        "timeline.csv");
    command.action(options, tell_detail);
}

}  // namespace regather::cli
