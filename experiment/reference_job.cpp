#include "experiment/reference_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capture/capture.h"
#include "scenes/camera_path.h"
#include "scenes/loader.h"
#include "trace/folder_lock.h"
#include "trace/text.h"

namespace regather::experiment {
namespace {

namespace fs = std::filesystem;

constexpr double save_every_seconds = 30, run_seconds = 1;  // a run of samples is as long as an end may take

/// Samples of the next run: one at first, then about a second's worth.
std::uint32_t next_run(const capture::Reference& reference, const ReferenceGoal& goal, double sample_seconds,
                       std::uint32_t least_samples) {
    const double room = std::min(run_seconds, goal.seconds - reference.seconds);
    const double fitting = sample_seconds > 0 ? std::floor(room / sample_seconds) : 1;
    const std::uint32_t samples = std::max(goal.samples, least_samples);
    return static_cast<std::uint32_t>(
        std::clamp(fitting, 1.0, static_cast<double>(samples - reference.samples)));
}

}  // namespace

void render(capture::Reference& reference, const scenes::Scene& scene, const ReferenceGoal& goal,
            const fs::path& folder, const ProgressListener& progress, std::uint32_t least_samples) {
    const capture::RayCaster caster(scene);
    const capture::LightSampler lights(scene);
    const capture::ReferenceKey& key = reference.key;
    const capture::PathTracer tracer(scene, caster, lights,
                                     {.width = key.width, .height = key.height, .seed = key.seed});
    const bool by_samples = std::isinf(goal.seconds);
    const std::uint64_t pixels = reference.pixels.size();
    // The first samples are saved at once: then there is something to go on from.
    double saved_at = reference.samples == 0 ? -save_every_seconds : reference.seconds, sample_seconds = 0;
    bool unsaved = false;
    const auto tell = [&] {
        if (!progress) return;
        if (by_samples)
            return progress("path tracing", "samples", reference.samples * pixels, goal.samples * pixels);
        progress("path tracing", "ms",
                 static_cast<std::uint64_t>(1000 * std::min(reference.seconds, goal.seconds)),
                 static_cast<std::uint64_t>(1000 * goal.seconds));
    };
    const auto keep = [&] {
        if (unsaved) save(reference, folder);
        unsaved = false;
        saved_at = reference.seconds;
    };
    try {
        while (!goal.reached(reference) || reference.samples < least_samples) {
            tell();
            const double before = reference.seconds;
            const std::uint32_t run = next_run(reference, goal, sample_seconds, least_samples);
            reference.add(tracer, run);
            sample_seconds = (reference.seconds - before) / run;
            unsaved = true;
            if (reference.seconds - saved_at >= save_every_seconds) keep();
        }
    } catch (...) {
        keep();
        if (reference.samples > 0) write_images(reference, folder);
        throw;
    }
    keep();
    if (reference.samples > 0) write_images(reference, folder);
}

capture::Reference run(const ReferenceJob& job, const ProgressListener& progress) {
    scenes::Scene scene = scenes::load_scene(job.scene);
    tell(job.note, scene.notes);
    if (job.frame) scene.camera = scenes::camera_at(scene, *job.frame);
    const trace::FolderLock lock(job.folder);
    capture::Reference reference = capture::resume_reference(
        job.folder, {scene.name, capture::checksum(scene), job.width, job.height, job.seed});
    render(reference, scene, job.goal, job.folder, progress);
    return reference;
}

std::string report(const capture::Reference& reference, const fs::path& folder) {
    const double noise = std::sqrt(reference.mean_variance()), mean = reference.mean_radiance();
    std::string text =
        fmt::format("{}: {} x {} pixels, {} samples a pixel in {:.1f} s\n", trace::shown(reference.key.scene),
                    reference.key.width, reference.key.height, reference.samples, reference.seconds);
    text += fmt::format("rays: {} and {} to lights\n", reference.counts.rays, reference.counts.shadow_rays);
    if (reference.samples > 1)
        text +=
            fmt::format("mean radiance {:.5g}; its own error: RMS over the pixels {:.3g}{}, median {:.3g}\n",
                        mean, noise, mean > 0 ? fmt::format(" ({:.2f} %)", 100 * noise / mean) : "",
                        std::sqrt(reference.median_variance()));
    if (reference.counts.cut_off > 0)
        text += fmt::format("{} of {} paths were cut off after {} surfaces: darker than the truth\n",
                            reference.counts.cut_off, reference.counts.samples,
                            capture::PathConfig{}.most_surfaces);
    if (const std::string bad = reference.counts.nonfinite.text(); !bad.empty()) text += bad + "\n";
    return text + fmt::format("{}\n", (folder / "reference.exr").string());
}

}  // namespace regather::experiment
