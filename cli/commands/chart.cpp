#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "charts/chart.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "results/accuracy.h"
#include "results/budget.h"
#include "results/rows.h"
#include "trace/error.h"
#include "trace/file.h"
#include "trace/text.h"

namespace regather::cli {
namespace {

struct Request {
    std::vector<std::string> csv, kinds;
    std::string cache;
    std::filesystem::path folder, front;
    std::uint64_t tile = 16, bins = 16;
    bool force = false;
};

void draw_charts(const Request& request, const Console& console) {
    charts::ChartOptions options;
    options.tile = request.tile;
    options.bins = request.bins;
    if (!request.cache.empty()) options.cache = results::parse_geometry(request.cache);
    for (const std::string& kind : request.kinds) charts::chart_kind(kind);

    results::Rows rows;
    for (const std::string& file : request.csv)
        for (const std::string& name : rows.add(results::read_csv_text(file), file))
            fmt::print(console.err, "regather: {}: the column {} is not known, and not looked at\n",
                       trace::shown(file, trace::most_shown_path), trace::in_quotes(name));
    const auto kinds = charts::wanted_kinds(rows, request.kinds);
    if (kinds.empty())
        throw trace::DataError(fmt::format("{}: no rows, expected at least one",
                                           trace::shown(request.csv[0], trace::most_shown_path)));
    for (const charts::ChartKind* const kind : kinds)
        trace::refuse_to_overwrite(charts::files_of(request.folder, *kind), request.force);
    if (!request.front.empty()) trace::refuse_to_overwrite(std::array{request.front}, request.force);
    const std::vector<results::Row> shown = results::rows_of_shape(rows.of<results::Row>(), options.cache);
    if (!request.front.empty() && std::none_of(kinds.begin(), kinds.end(), [](const auto* kind) {
            return kind->name == "best-under-budget";
        }))
        throw trace::UsageError("--front: found, but not the kind best-under-budget, whose rows it writes");
    bool any = false;
    std::string skipped;
    for (const auto& drawn : charts::write_charts(request.folder, rows, request.kinds, options)) {
        for (const auto& file : drawn.files) console.print("{}\n", file.string());
        any |= !drawn.files.empty();
        if (drawn.kind == "sampling-error" && !drawn.files.empty())
            console.print("{}", results::text_of(results::accuracy_table(rows.of<results::SamplingRow>())));
        if (drawn.kind == "best-under-budget" && !drawn.files.empty())
            console.print("{}", results::text_of(results::budget_tables(shown), 120));
        if (drawn.skipped.empty()) continue;
        const std::string line =
            fmt::format("{}: not drawn: {}", drawn.kind, trace::shown(drawn.skipped, 300));
        console.print("{}\n", line);
        if (skipped.empty()) skipped = line;
    }
    if (!request.front.empty()) {
        results::write_csv<results::Row>(request.front, results::front_rows(shown));
        console.print("rows: {}\n", request.front.string());
    }
    // What was asked for by name must be there; of "every kind that applies" at least one.
    if (!skipped.empty() && (!any || !request.kinds.empty())) throw trace::DataError(skipped);
}

std::string chart_footer() {
    std::string out = "Kinds:\n";
    for (const auto& kind : charts::chart_kinds())
        out += fmt::format("  {:<22}{}; needs {}\n", kind.name, kind.title, kind.needs);
    return out +
           "\nExamples:\n"
           "  regather chart runs/room/rows.csv -o runs/room/charts\n"
           "  regather chart mine.csv -o charts --kind traffic-by-tile --cache 64K:64:full --force\n"
           "  regather chart rows.csv sampling.csv -o charts\n";
}

}  // namespace

void add_chart(Command& command) {
    auto request = std::make_shared<Request>();
    command.arguments("CSV", request->csv, "files of rows, taken together; the header tells the kind of each")
        .required();
    command.option("-o,--output", request->folder, "folder for the charts, made when missing").required();
    command.comma_list("--kind", request->kinds, "which charts; without it, each that the rows allow");
    command.option("--cache", request->cache,
                   "SIZE:LINE:WAYS of the rows to draw, as 128K:128:8; without it, the commonest");
    command.option("--tile", request->tile, {1}, "tile edge [pixels] where it is not the axis");
    command.option("--bins", request->bins, {1}, "direction bins (n of n x n) where they are not the axis");
    command.option("--front", request->front,
                   "write the rows on the curves of best-under-budget here, a CSV");
    command.flag("--force", request->force, "replace files that exist");
    command.footer(chart_footer());
    command.action(request, draw_charts);
}

}  // namespace regather::cli
