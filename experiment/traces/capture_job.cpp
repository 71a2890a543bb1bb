#include "experiment/traces/capture_job.h"

#include <fmt/format.h>

#include <optional>

#include "capture/fingerprint.h"
#include "experiment/frames.h"
#include "scenes/camera_path.h"
#include "scenes/loader.h"
#include "trace/error.h"
#include "trace/folder.h"
#include "trace/text.h"

namespace regather::experiment {
namespace {

using capture::Beside;

namespace fs = std::filesystem;

bool has_columns(const trace::TraceReader& trace, const capture::CaptureConfig& config) {
    const capture::Columns& columns = config.columns;
    const bool gathered = config.pixels.visualisation == capture::Visualisation::final_gather;
    return (!columns.direction || trace.has("query_direction")) &&
           (!columns.leaf_kd || trace.has("query_leaf_kd")) &&
           (!columns.leaf_bvh || trace.has("query_leaf_bvh")) &&
           (!columns.stratum || !gathered || trace.has("query_stratum")) &&
           (!columns.rays || trace.has("ray_eye_origin"));
}

std::string figures(const trace::TraceInfo& info) {
    const double queries = static_cast<double>(std::max<std::uint64_t>(info.queries, 1));
    return fmt::format(
        "  {} map: {} photons, {} queries, {:.1f} photons found and {:.1f} nodes visited a query\n", info.map,
        info.photons, info.queries, static_cast<double>(info.found_photons) / queries,
        static_cast<double>(info.visited_nodes) / queries);
}

/// What packed photons did to the image; nothing of whole ones.
std::string record_figures(const trace::TraceInfo& info) {
    const auto figure = [&](const char* name) {
        const trace::Json* const found = info.counts.find(name);
        return found ? found->number() : 0;
    };
    if (!info.counts.find("packed_farthest")) return {};
    return fmt::format(
        "  photons of 16 bytes: moved by at most {:.3g}; the image against that from 20 bytes: RMS {:.3g} % "
        "of "
        "its mean, mean {:+.3g} %, FLIP {:.3g}\n",
        figure("packed_farthest"), 100 * figure("packed_relative_rmse"), 100 * figure("packed_relative_mean"),
        figure("packed_flip"));
}

/// What an irradiance cache did; nothing where there is none.
std::string irradiance_figures(const trace::TraceInfo& info) {
    if (!info.counts.find("irradiance_records")) return {};
    const auto count = [&](const char* name) {
        return static_cast<std::uint64_t>(info.counts.find(name)->number());
    };
    const std::uint64_t served = count("irradiance_points_served"),
                        points = served + count("irradiance_points_not_served"),
                        records = count("irradiance_records"), rays = count("irradiance_rays");
    const auto share = [](std::uint64_t part, std::uint64_t of) {
        return static_cast<double>(part) / static_cast<double>(std::max<std::uint64_t>(of, 1));
    };
    return fmt::format(
               "  irradiance cache: {} records of {} rays and {} queries in all, an octree of {} bytes; {} "
               "of "
               "{} points served ({:.2f} %), hit rate {:.2f} %, {} gather rays saved, {:.1f} for one of a "
               "record\n",
               records, rays, count("irradiance_queries"), count("irradiance_octree_bytes"), served, points,
               100 * share(served, points), 100 * share(served - std::min(records, served), points),
               count("irradiance_rays_saved"), share(count("irradiance_rays_saved"), rays)) +
           fmt::format(
               "  from one gather origin to the next of a tile: {:.3f} of its extent, {:.3f} without "
               "records\n",
               info.counts.find("irradiance_scatter")->number(),
               info.counts.find("irradiance_scatter_of_all")->number()) +
           fmt::format(
               "  if records took a while: {} begun, {} without a place to wait; {} points wait, at "
               "most {} at once, half of them at most {}, 90 % {}, 99 % {}, all {}; {} stopped\n",
               count("irradiance_waiting_records"), count("irradiance_waiting_records_unheld"),
               count("irradiance_waiting_points"), count("irradiance_waiting_most"),
               count("irradiance_waiting_half"), count("irradiance_waiting_nine_tenths"),
               count("irradiance_waiting_ninety_nine"), count("irradiance_waiting_longest"),
               count("irradiance_waiting_stopped"));
}

std::string octree_figures(const trace::TraceInfo& info) {
    return fmt::format("  its octree: {} searches, {:.1f} cells and records visited a search\n", info.queries,
                       static_cast<double>(info.visited_nodes) /
                           static_cast<double>(std::max<std::uint64_t>(info.queries, 1)));
}

std::string reverse_figures(const trace::TraceInfo& info) {
    return fmt::format(
        "  photons: {} searches of hit points, {:.1f} of them and sums of pixels visited a search\n",
        info.queries,
        static_cast<double>(info.visited_nodes) /
            static_cast<double>(std::max<std::uint64_t>(info.queries, 1)));
}

constexpr Beside all_beside[] = {Beside::caustic,           Beside::guide,      Beside::precompute,
                                 Beside::reverse,           Beside::irradiance, Beside::irradiance_rounds,
                                 Beside::irradiance_inserts};

/// All that is said of the traces, of the records and of the cache.
std::string figures_of(const trace::TraceInfo& info,
                       const capture::OfBeside<std::optional<trace::TraceInfo>>& beside) {
    std::string report;
    for (const Beside which : {Beside::caustic, Beside::guide, Beside::precompute})
        if (beside[which]) report += figures(*beside[which]);
    if (beside[Beside::reverse]) report += reverse_figures(*beside[Beside::reverse]);
    report += record_figures(info) + irradiance_figures(info);
    if (beside[Beside::irradiance]) report += octree_figures(*beside[Beside::irradiance]);
    return report;
}

/// Where the parts of one captured frame lie.
struct Files {
    explicit Files(const fs::path& folder)
        : exr(folder / "image.exr"), png(folder / "image.png"), trace(folder / "trace") {
        for (std::size_t t = 0; t < capture::beside_folders.size(); ++t)
            beside.all[t] = folder / capture::beside_folders[t];
    }
    fs::path exr, png, trace;
    capture::OfBeside<fs::path> beside;
};

/// What is said of a finished capture of the same; nothing when there is none.
std::optional<std::string> kept(const fs::path& folder, const Files& files, const scenes::Scene& scene,
                                const capture::CaptureConfig& config) {
    if (!fs::exists(files.trace / "trace.json")) return std::nullopt;
    const trace::TraceReader trace(files.trace);
    if (trace.info().parameters != capture::parameters(scene, config) || !has_columns(trace, config))
        throw trace::UsageError(fmt::format(
            "{}: holds a trace with other parameters or columns than asked for, or of another renderer; "
            "give another folder, or --force to capture again",
            files.trace.string()));
    for (const fs::path& image : {files.exr, files.png})
        if (!fs::exists(image))
            throw trace::UsageError(fmt::format("{}: holds the trace, but no {}; --force captures again",
                                                folder.string(), image.filename().string()));
    std::string report =
        fmt::format("kept the finished capture in {}\n{}", folder.string(), figures(trace.info()));
    capture::OfBeside<std::optional<trace::TraceInfo>> beside;
    for (const Beside which : all_beside)
        if (capture::has(which, scene, config))
            beside[which] = trace::TraceReader(files.beside[which]).info();
    report += figures_of(trace.info(), beside);
    return report;
}

/// One picture, with its traces, into `folder`.
std::string capture_into(const fs::path& folder, const scenes::Scene& scene, capture::CaptureConfig config,
                         const CaptureOptions& options, bool force, const ProgressListener& progress) {
    const Files files(folder);
    if (!force)
        if (const auto report = kept(folder, files, scene, config)) return *report;
    capture::OfBeside<bool> wanted;
    for (const Beside which : all_beside) wanted[which] = capture::has(which, scene, config);
    fs::create_directories(folder);
    trace::TraceWriter writer(files.trace, force);
    // Without the others it is no finished capture.
    capture::OfBeside<std::optional<trace::TraceWriter>> beside;
    capture::TraceWriters writers{&writer, {}};
    for (const Beside which : all_beside) {
        if (wanted[which])
            writers.beside[which] = &beside[which].emplace(files.beside[which], true);
        else
            fs::remove_all(files.beside[which]);
    }
    const std::string shown = trace::shown(scene.name);
    const std::string name = config.frame ? fmt::format("{}, frame {}", shown, *config.frame) : shown;
    config.progress = [&](std::string_view stage, std::uint64_t done, std::uint64_t total) {
        if (progress) progress(fmt::format("capturing {}: {}", name, stage), stage, done, total);
    };
    const capture::Captured captured = capture::capture(scene, config, writers);
    std::vector<capture::Channel> channels = capture::channels_of(captured.image, "");
    for (capture::Channel& channel : captured.layers.channels()) channels.push_back(std::move(channel));
    capture::write_exr(files.exr, captured.image.width, captured.image.height, channels);
    const float exposure = options.exposure > 0 ? static_cast<float>(options.exposure)
                                                : capture::middle_exposure(captured.image);
    capture::write_png(files.png, captured.image, exposure, options.tone_curve());
    for (const Beside which : all_beside)
        if (beside[which]) beside[which]->finish(*captured.beside[which]);
    writer.finish(captured.info);

    std::string report =
        fmt::format("captured {} ({} triangles{})\n{}", trace::shown(scene.name), scene.triangles.size(),
                    config.frame ? fmt::format(", frame {}", *config.frame) : "", figures(captured.info));
    report += figures_of(captured.info, captured.beside);
    report += fmt::format(
        "  seconds: photons {:.1f}, trees {:.1f}, queries {:.1f}, gathers {:.1f}, writing {:.1f}\n",
        captured.photon_seconds, captured.tree_seconds, captured.query_seconds, captured.gather_seconds,
        captured.write_seconds);
    for (const trace::LeftOut& part : captured.info.left_out)
        report += fmt::format("  left out {}: {}\n", trace::shown(part.what), trace::shown(part.why, 200));
    if (captured.nonfinite.total() > 0) report += fmt::format("  {}\n", captured.nonfinite.text());
    report += fmt::format("  image: {} and {}\n  trace: {}\n", files.exr.string(), files.png.string(),
                          files.trace.string());
    for (const Beside which : all_beside)
        if (beside[which]) report += fmt::format("  beside it: {}\n", files.beside[which].string());
    return report;
}

}  // namespace

std::uint32_t frames_of(const scenes::Scene& scene) {
    return scene.camera_path.empty() ? 0 : scene.frames;
}

CaptureResult run(const CaptureJob& job, const ProgressListener& progress) {
    scenes::Scene scene = scenes::load_scene(job.scene);
    tell(job.note, scene.notes);
    capture::CaptureConfig config = job.options.config();
    config.renderer = capture::fingerprint(scene);
    if (job.reads) {
        config.columns.direction = job.reads->direction || job.reads->captured;
        config.columns.leaf_kd = job.reads->leaf_kd || job.reads->captured;
        config.columns.leaf_bvh = job.reads->leaf_bvh || job.reads->captured;
        config.columns.stratum = job.reads->stratum;
    }
    CaptureResult result;
    if (job.options.frames.empty()) {
        result.report = capture_into(job.folder, scene, config, job.options, job.force, progress);
        result.folders.push_back(job.folder);
        return result;
    }
    for (const std::uint32_t frame : parse_frames(job.options.frames, frames_of(scene))) {
        const fs::path folder = frame_folder(job.folder, frame);
        scene.camera = scenes::camera_at(scene, frame);
        config.frame = frame;
        result.report += capture_into(folder, scene, config, job.options, job.force, progress);
        result.folders.push_back(folder);
    }
    return result;
}

}  // namespace regather::experiment
