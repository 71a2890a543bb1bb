// regather heatmap -- which pixels move how many bytes, by ordering, as channels of an EXR and as a picture.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "capture/image.h"
#include "charts/heat_map.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "experiment/measurement.h"
#include "replay/pixel_traffic.h"
#include "results/geometry.h"
#include "trace/error.h"

namespace regather::cli {
namespace {

struct Options {
    std::filesystem::path trace, folder;
    std::vector<std::string> orders{"naive", "hilbert"};
    std::string cache = "128K:128:8";
    bool force = false;
};

void run(const Options& options) {
    const std::filesystem::path exr = options.folder / "traffic.exr", png = options.folder / "traffic.png";
    for (const std::filesystem::path& file : {exr, png})
        if (!options.force && std::filesystem::exists(file))
            throw trace::UsageError(fmt::format("{}: exists; --force overwrites it", file.string()));
    const std::vector<cachesim::CacheConfig> caches = experiment::parse_caches(options.cache);
    if (caches.size() != 1)
        throw trace::UsageError(fmt::format("--cache: found {}, expected one cache", options.cache));
    auto [orderings, reads] = experiment::parse_orderings(options.orders);
    trace::TraceReader trace(options.trace);
    const experiment::Measurement measurement(trace, reads, reorder::default_onchip_bytes);
    const trace::TraceInfo& info = trace.info();
    const auto query_pixel = trace.column<std::uint32_t>("query_pixel");
    std::vector<charts::HeatMap> maps;
    std::vector<capture::Channel> channels;
    {
        Progress progress;
        for (const reorder::ParsedOrdering& parsed : orderings) {
            const reorder::Ordered ordered = measurement.order(*parsed.ordering);
            const std::string text = "replaying " + parsed.spec.text;
            maps.push_back(
                {parsed.spec.text,
                 replay::pixel_traffic(measurement.walks(), measurement.layout(), ordered.permutation,
                                       query_pixel, std::uint64_t{info.image_width} * info.image_height,
                                       caches[0], [&](std::uint64_t done) {
                                           progress.update(text, "queries", done, measurement.queries());
                                       })});
            channels.push_back({fmt::format("{}.bytes", parsed.spec.text),
                                {maps.back().bytes.begin(), maps.back().bytes.end()}});
        }
    }
    std::filesystem::create_directories(options.folder);
    capture::write_exr(exr, info.image_width, info.image_height, channels);
    const results::Geometry geometry{caches[0].size_bytes, caches[0].line_bytes, caches[0].ways};
    charts::write_heat_map(png, maps, info.image_width, info.image_height,
                           fmt::format("{}, {} queries, {}, LRU; white: none moved", info.scene,
                                       results::decimal_count(static_cast<double>(info.queries)),
                                       results::geometry_text(geometry)));
    fmt::print("heat map: {} and {}\n", png.string(), exr.string());
}

}  // namespace

void add_heatmap(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("heatmap", "bytes moved by each pixel, by ordering, as an image");
    command->add_option("trace", options->trace, "the folder of a finished trace")->required();
    command
        ->add_option("--order,--reorderer", options->orders,
                     "orderings as NAME:parameter=value,...; or the path of a shared library")
        ->capture_default_str();
    command->add_option("--cache", options->cache, "a cache as SIZE:LINE:WAYS; WAYS may be full")
        ->capture_default_str();
    command->add_option("-o,--output", options->folder, "folder for traffic.exr and traffic.png")->required();
    command->add_flag("--force", options->force, "overwrite the files");
    command->footer(
        "Example:\n  regather heatmap out/room/trace --order naive hilbert:tile=16 hilbert -o out/room");
    command->callback([options] { run(*options); });
}

}  // namespace regather::cli
