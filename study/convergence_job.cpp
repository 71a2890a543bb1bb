#include "study/convergence_job.h"

#include <fmt/format.h>

#include <algorithm>

#include "capture/capture.h"
#include "capture/fingerprint.h"
#include "capture/images/image_strip.h"
#include "experiment/reference_job.h"
#include "results/csv.h"
#include "scenes/camera_path.h"
#include "scenes/loader.h"
#include "trace/error.h"
#include "trace/file.h"
#include "trace/folder_lock.h"

namespace regather::study {
namespace {

namespace fs = std::filesystem;

constexpr double reference_share = 0.4;     // of the time, when there is none yet
constexpr std::uint32_t least_samples = 2;  // to know the reference's own error

/// A finished one.
capture::Reference loaded_reference(const scenes::Scene& scene, const ConvergenceJob& job,
                                    const fs::path& folder, std::uint32_t width, std::uint32_t height) {
    capture::Reference found = capture::load_reference(folder);
    if (found.key.scene_checksum != capture::checksum(scene))
        throw trace::UsageError(
            fmt::format("{}: found a reference of another scene or camera ({}), expected one of {}",
                        folder.string(), found.key.scene, scene.name));
    if ((job.width && *job.width != found.key.width) ||
        ((job.width || job.height) && height != found.key.height))
        throw trace::UsageError(
            fmt::format("{}: found a reference of {} x {} pixels, expected {} x {} as asked for",
                        folder.string(), found.key.width, found.key.height, width, height));
    if (found.samples < least_samples)
        throw trace::UsageError(
            fmt::format("{}: found {} samples a pixel, expected at least {}, to know the reference's error",
                        folder.string(), found.samples, least_samples));
    return found;
}

/// The given one; or the folder's own, which is rendered to its end as long as no rows were measured against
/// it.
capture::Reference reference_of(const scenes::Scene& scene, const ConvergenceJob& job, bool has_rows,
                                const experiment::ProgressListener& progress) {
    const fs::path folder = job.reference.empty() ? job.folder / "reference" : job.reference;
    const std::uint32_t width = job.width.value_or(64), height = job.height.value_or(width);
    if (!job.reference.empty() || has_rows) return loaded_reference(scene, job, folder, width, height);
    if (capture::holds_reference(folder) && capture::load_reference(folder).samples >= least_samples)
        loaded_reference(scene, job, folder, width, height);  // refuses one of something else
    capture::ReferenceKey key{scene.name, capture::checksum(scene), width, height, 1};
    if (capture::holds_reference(folder)) key = capture::load_reference(folder).key;
    capture::Reference reference = capture::resume_reference(folder, key);
    experiment::render(reference, scene, {.seconds = reference_share * job.seconds}, folder, progress,
                       least_samples);
    return reference;
}

std::vector<Setting> ladder_of(const scenes::Scene& scene, const fs::path& file) {
    if (!file.empty()) return parse_ladder(trace::read_file(file), file.string());
    const trace::Bounds3 box = scene.bounds();
    return default_ladder(static_cast<double>(trace::length(box.max - box.min)),
                          capture::has_caustic_map(scene, capture::CaptureConfig()));
}

std::string strip_title(const Setting& setting) {
    const bool direct = setting.mode == capture::Visualisation::direct;
    return fmt::format("{}n={} k={}", direct ? "" : fmt::format("rays={} ", setting.gather_rays),
                       setting.photons, setting.k);
}

/// Strips of the quickest and of the slowest setting of each ladder; settings come in rising cost.
void write_strips(const fs::path& folder, const Setting& setting, const capture::Image& image,
                  const capture::Image& reference) {
    fs::create_directories(folder);
    const capture::Picture strip =
        capture::image_strip(image, reference, {strip_title(setting), "reference"});
    const fs::path quickest = folder / fmt::format("{}-quickest.png", setting.ladder);
    if (!fs::exists(quickest)) capture::write_strip(quickest, strip);
    capture::write_strip(folder / fmt::format("{}-slowest.png", setting.ladder), strip);
}

/// What a killed run began to write.
void remove_unfinished(const fs::path& folder) {
    if (!fs::is_directory(folder)) return;
    std::vector<fs::path> unfinished;
    for (const auto& entry : fs::directory_iterator(folder))
        if (const std::string name = entry.path().filename().string();
            name.starts_with("partial-") || name.ends_with(".partial"))
            unfinished.push_back(entry.path());
    for (const fs::path& path : unfinished) fs::remove(path);
}

std::vector<results::ConvergenceRow> known_rows(const fs::path& csv, const Convergence& convergence) {
    const auto rows = results::read_csv<results::ConvergenceRow>(csv);
    for (const results::ConvergenceRow& row : rows)
        if (!convergence.belongs(row))
            throw trace::UsageError(fmt::format(
                "{}: holds rows of another scene, reference, size, number of seeds or shadow rays; give "
                "another folder, or --force to begin again",
                csv.string()));
    return rows;
}

}  // namespace

Converged run(const ConvergenceJob& job, const experiment::ProgressListener& progress,
              const RowsWritten& written) {
    scenes::Scene scene = scenes::load_scene(job.scene);
    experiment::tell(job.note, scene.notes);
    const std::string renderer = capture::fingerprint(scene);
    if (job.frame) scene.camera = scenes::camera_at(scene, *job.frame);
    const std::vector<Setting> ladder = ladder_of(scene, job.ladder);
    const fs::path csv = job.folder / "converge.csv", strips = job.folder / "strips";
    const bool has_rows = !job.force && fs::exists(csv);
    const trace::FolderLock lock(job.folder);
    Converged result{scene.name, renderer, reference_of(scene, job, has_rows, progress), {}, 0, 0, {}, 0, 0,
                     0,          csv};
    const capture::ReferenceKey& key = result.reference.key;
    result.config.width = key.width;
    result.config.height = key.height;
    result.config.seeds = job.seeds;
    result.config.shadow_rays = job.shadow_rays;
    const Convergence convergence(scene, truth_of(result.reference), result.config);
    if (has_rows) result.rows = known_rows(csv, convergence);
    remove_unfinished(strips);
    result.known = result.rows.size();
    result.settings = ladder.size();
    result.mean_radiance = convergence.mean_radiance();
    result.reference_rmse = convergence.reference_rmse();

    const capture::Image truth = result.reference.mean();
    const std::vector<results::ConvergenceRow> known = result.rows;
    const auto told = [&](const Setting&, double share) {
        if (progress)
            progress(fmt::format("converging {}", scene.name), "steps",
                     static_cast<std::uint64_t>(10000 * share), 10000);
    };
    const auto measured = [&](const Setting& setting, const Measured& found) {
        result.rows.push_back(found.row);
        results::write_csv<results::ConvergenceRow>(csv,
                                                    result.rows);  // a run that is stopped goes on from here
        if (written) written(result);
        write_strips(strips, setting, found.first, truth);
    };
    const double left = job.reference.empty() ? job.seconds * (1 - reference_share) : job.seconds;
    result.skipped = run(convergence, result.config, {ladder, known, left, told, measured}).size();
    return result;
}

}  // namespace regather::study
