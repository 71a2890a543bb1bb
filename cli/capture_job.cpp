#include "cli/capture_job.h"

#include <fmt/format.h>

#include "cli/progress.h"
#include "scenes/loader.h"
#include "trace/error.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;

bool has_columns(const trace::TraceReader& trace, const capture::Columns& columns) {
    return (!columns.direction || trace.has("query_direction")) && (!columns.leaf_kd || trace.has("query_leaf_kd")) &&
           (!columns.leaf_bvh || trace.has("query_leaf_bvh")) && (!columns.rays || trace.has("ray_eye_origin"));
}

std::string figures(const trace::TraceInfo& info) {
    const double queries = static_cast<double>(std::max<std::uint64_t>(info.queries, 1));
    return fmt::format("  {} photons, {} queries, {:.1f} photons found and {:.1f} nodes visited a query\n", info.photons,
                       info.queries, static_cast<double>(info.found_photons) / queries,
                       static_cast<double>(info.visited_nodes) / queries);
}

}  // namespace

CaptureResult run(const CaptureJob& job) {
    const scenes::Scene scene = scenes::load_scene(job.scene);
    capture::CaptureConfig config = job.options.config();
    if (job.reads) {
        config.columns.direction = job.reads->direction;
        config.columns.leaf_kd = job.reads->leaf_kd;
        config.columns.leaf_bvh = job.reads->leaf_bvh;
    }
    const fs::path trace_folder = job.folder / "trace";
    if (!job.force && fs::exists(trace_folder / "trace.json")) {
        const trace::TraceReader trace(trace_folder);
        if (trace.info().parameters != capture::parameters(scene, config) || !has_columns(trace, config.columns))
            throw trace::UsageError(fmt::format("{}: holds a trace with other parameters or columns than asked for; give "
                                                "another folder, or --force to capture again", trace_folder.string()));
        for (const char* image : {"image.exr", "image.png"})
            if (!fs::exists(job.folder / image))
                throw trace::UsageError(fmt::format("{}: holds the trace, but no {}; --force captures again",
                                                    job.folder.string(), image));
        return {fmt::format("kept the finished capture in {}\n{}", job.folder.string(), figures(trace.info()))};
    }

    fs::create_directories(job.folder);
    trace::TraceWriter writer(trace_folder, job.force);
    capture::Captured captured;
    {
        Progress progress;
        config.progress = [&](std::string_view stage, std::uint64_t done, std::uint64_t total) {
            progress.update(fmt::format("capturing {}: {}", scene.name, stage), stage, done, total);
        };
        captured = capture::capture(scene, config, &writer);
    }
    const fs::path exr = job.folder / "image.exr", png = job.folder / "image.png";
    capture::write_exr(exr, captured.image);
    capture::write_png(png, captured.image, capture::middle_exposure(captured.image));
    writer.finish(captured.info);

    CaptureResult result;
    result.report = fmt::format("captured {} ({} triangles)\n{}", scene.name, scene.triangles.size(), figures(captured.info));
    result.report += fmt::format("  seconds: photons {:.1f}, tree {:.1f}, queries {:.1f}, gathers {:.1f}, writing {:.1f}\n",
                                 captured.photon_seconds, captured.tree_seconds, captured.query_seconds,
                                 captured.gather_seconds, captured.write_seconds);
    for (const trace::LeftOut& part : captured.info.left_out)
        result.report += fmt::format("  left out {}: {}\n", part.what, part.why);
    if (captured.nonfinite_pixels > 0)
        result.report += fmt::format("  {} pixels were not finite and are black\n", captured.nonfinite_pixels);
    result.report += fmt::format("  image: {} and {}\n  trace: {}\n", exr.string(), png.string(), trace_folder.string());
    return result;
}

}  // namespace regather::cli
