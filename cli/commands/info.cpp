// regather info -- what a trace holds, or what a scene needs of a capture.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "capture/irradiance/open_surfaces.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "replay/verification.h"
#include "scenes/loader.h"
#include "scenes/needs.h"
#include "spatial/photons/recall.h"
#include "spatial/rays/ray_structures.h"
#include "trace/error.h"
#include "trace/folder.h"
#include "trace/text.h"

namespace regather::cli {
namespace {

constexpr std::size_t most_shown_json = 4000;  // a capture's has some hundred bytes

std::string searched(const trace::TraceReader& trace) {
    const trace::TraceInfo& info = trace.info();
    if (trace.has("photon")) return fmt::format("{} photons, k = {}", info.photons, info.k);
    const auto elements = trace.digests().find("element_region");
    return fmt::format("{} elements", elements == trace.digests().end() ? 0 : elements->second.rows);
}

/// What a search of every query has shown again.
std::string searched_again(const trace::TraceReader& trace) {
    std::string text = "; each query was searched again and walks the same way";
    if (trace.has("candidate")) text += ", with the same candidates";
    if (trace.info().counts.find(spatial::nearest_found_count))
        text += ", and misses as many of the nearest photons";
    return text;
}

void print_trace(const std::filesystem::path& folder, bool verify, const Console& console) {
    trace::TraceReader trace(folder);
    replay::Verified verified;
    if (verify) {
        Progress progress(console);
        const experiment::ProgressListener told = progress.listener();
        verified = replay::verify(trace, [&](std::uint64_t done) {
            told("searching again", "queries", done, trace.info().queries);
        });
    }
    const trace::TraceInfo& info = trace.info();
    const bool of_rays = spatial::is_ray_structure(info.structure);
    const double queries = static_cast<double>(std::max<std::uint64_t>(info.queries, 1));
    console.print(
        "trace      {}\nscene      {}{}\nmap        {}\nimage      {} x {} pixels\nseed       {}\nstructure  "
        "{}, {}\n",
        trace::shown(folder.string(), trace::most_shown_path), trace::shown(info.scene),
        info.frame ? fmt::format(", frame {}", *info.frame) : "", info.map, info.image_width,
        info.image_height, info.seed, info.structure, of_rays ? "rays" : searched(trace));
    console.print(
        "queries    {}: {}{:.1f} nodes visited, {:.1f} bytes of walk each\n", info.queries,
        of_rays ? ""
                : fmt::format("{:.1f} photons found, ", static_cast<double>(info.found_photons) / queries),
        static_cast<double>(info.visited_nodes) / queries,
        static_cast<double>(trace.digests().at("walk").rows) / queries);
    console.print("checksum   {}\nparameters {}\ncounts     {}\ncolumns\n", trace.checksum(),
                  trace::shown(info.parameters.dump(), most_shown_json),
                  trace::shown(info.counts.dump(), most_shown_json));
    for (const trace::ColumnEntry& entry : trace::column_table()) {
        if (!trace.has(entry.name)) continue;
        const std::uint64_t rows = trace.digests().at(std::string(entry.name)).rows;
        console.print("  {:<24} {:>12} rows  {:>9.1f} MB  {} [{}]\n", entry.name, rows,
                      static_cast<double>(rows * entry.type().row_bytes) / 1e6, entry.type().readable,
                      entry.unit);
    }
    for (const trace::LeftOut& part : info.left_out)
        console.print("left out   {}: {}\n", trace::shown(part.what), trace::shown(part.why, 200));
    if (!verify) return;
    console.print("verified   checksums, {}, pixels, directions, rays, walks{}\n",
                  trace.has("photon") ? "the order of the tree" : "elements",
                  verified.searched     ? searched_again(trace)
                  : of_rays             ? "; not cast again: a trace of rays does not hold the triangles"
                  : trace.has("photon") ? "; not searched again: trace.json does not say the radius"
                                        : "; not searched again: the walks were brought");
    if (verified.queries_nowhere > 0)
        console.print("           {} queries are at no finite place and find nothing\n",
                      verified.queries_nowhere);
}

}  // namespace

void add_info(Command& command) {
    struct Options {
        std::string what;
        bool verify = false;
    };
    auto options = std::make_shared<Options>();
    command.argument("what", options->what, "a trace's folder, an embedded scene's name or a scene file")
        .required();
    command.flag("--verify", options->verify,
                 "read every column of a trace, check it, and search each query again");
    command.footer("Examples:\n  regather info out/room/trace --verify\n  regather info room");
    command.action(options, [](const Options& asked, const Console& console) {
        std::error_code error;
        if (std::filesystem::is_directory(asked.what, error))
            return print_trace(asked.what, asked.verify, console);
        const scenes::Scene scene = scenes::load_scene(asked.what);
        console.note(scene.notes);
        if (asked.verify)
            throw trace::UsageError(
                fmt::format("--verify: found with the scene {}, expected a trace's folder: a scene is "
                            "checked in any case",
                            trace::shown(scene.name)));
        console.print("scene      {}, {} triangles, {} materials, {} lights\n", trace::shown(scene.name),
                      scene.triangles.size(), scene.materials.size(), scene.lights.size());
        const scenes::Needs needs = scenes::needs_of(scene);
        for (const scenes::Need* need : needs.list())
            console.print("{:<10} {}: {}\n", need->needed ? "needed" : "left out", need->part, need->reason);
        console.print("left out   irradiance_cache: unless --irradiance-cache asks for it. {}\n",
                      capture::open_surfaces(scene).text());
    });
}

}  // namespace regather::cli
