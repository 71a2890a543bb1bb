// regather heatmap -- which pixels move how many bytes, by ordering, as channels of an EXR and as a picture.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>

#include "cachesim/cache_list.h"
#include "capture/images/image.h"
#include "charts/heat_map.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "experiment/traffic_map.h"
#include "results/geometry.h"
#include "trace/error.h"
#include "trace/file.h"

namespace regather::cli {
namespace {

struct HeatmapOptions {
    std::filesystem::path trace, folder;
    std::vector<std::string> orders{"naive", "hilbert"};
    std::string cache = "128K:128:8";
    bool force = false;
};

void draw_heatmap(const HeatmapOptions& options, const Console& console) {
    const std::filesystem::path exr = options.folder / "traffic.exr", png = options.folder / "traffic.png";
    trace::refuse_to_overwrite(std::array{exr, png}, options.force);
    const auto caches = cachesim::parse_caches(options.cache);
    if (caches.size() != 1)
        throw trace::UsageError(fmt::format("--cache: found {}, expected one cache", options.cache));
    const experiment::Orderings orderings = experiment::parse_orderings(options.orders);
    trace::TraceReader trace(options.trace);
    const trace::TraceInfo& info = trace.info();
    const auto traffic = experiment::traffic_maps(trace, orderings, caches[0], Progress(console).listener());
    std::vector<charts::HeatMap> maps;
    std::vector<capture::Channel> channels;
    for (const experiment::TrafficMap& map : traffic) {
        maps.push_back({map.ordering, map.bytes});
        channels.push_back({fmt::format("{}.bytes", map.ordering), {map.bytes.begin(), map.bytes.end()}});
    }
    std::filesystem::create_directories(options.folder);
    capture::write_exr(exr, info.image_width, info.image_height, channels);
    const results::Geometry geometry{caches[0].size_bytes, caches[0].line_bytes, caches[0].ways};
    charts::write_heat_map(png, maps, info.image_width, info.image_height,
                           fmt::format("{}, {} queries, {}, LRU; white: none moved", info.scene,
                                       results::decimal_count(static_cast<double>(info.queries)),
                                       results::geometry_text(geometry)));
    console.print("heat map: {} and {}\n", png.string(), exr.string());
}

}  // namespace

void add_heatmap(Command& command) {
    auto options = std::make_shared<HeatmapOptions>();
    command.argument("trace", options->trace, "the folder of a finished trace").required();
    command.list("--order,--reorderer", options->orders,
                 "orderings as NAME:parameter=value,...; file:KEYS.npy; or the path of a shared library");
    command.option("--cache", options->cache, "a cache as SIZE:LINE:WAYS; WAYS may be full");
    command.option("-o,--output", options->folder, "folder for traffic.exr and traffic.png").required();
    command.flag("--force", options->force, "overwrite the files");
    command.footer(
        "Example:\n  regather heatmap out/room/trace --order naive hilbert:tile=16 hilbert -o out/room");
    command.action(options, draw_heatmap);
}

}  // namespace regather::cli
