// regather reference -- renders a scene by path tracing, for as long as it takes: stops, goes on, adds
// samples.
#include <fmt/format.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "capture/capture.h"
#include "capture/reference.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "scenes/camera_path.h"
#include "scenes/loader.h"
#include "trace/error.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;

constexpr double save_every_seconds = 30, run_seconds = 1;  // a run of samples is as long as Ctrl-C may take
volatile sig_atomic_t interrupted = 0;

/// SIGINT and SIGTERM ask for an end, the second time at once.
class EndSignals {
public:
    EndSignals() {
        struct sigaction action {};
        action.sa_handler = [](int) { interrupted = 1; };
        action.sa_flags = static_cast<int>(SA_RESETHAND);
        sigaction(SIGINT, &action, &interrupt_);
        sigaction(SIGTERM, &action, &terminate_);
    }
    EndSignals(const EndSignals&) = delete;
    EndSignals& operator=(const EndSignals&) = delete;
    ~EndSignals() {
        sigaction(SIGINT, &interrupt_, nullptr);
        sigaction(SIGTERM, &terminate_, nullptr);
    }

private:
    struct sigaction interrupt_ {
    }, terminate_{};
};

struct Options {
    std::string scene;
    fs::path folder;
    std::uint32_t width = 512, height = 512;
    std::uint64_t seed = 1;
    std::optional<std::uint32_t> samples, frame;
    std::optional<double> seconds;
};

/// What the reference has been asked for: samples, seconds, or whichever of both comes first.
struct Goal {
    std::uint32_t samples = std::numeric_limits<std::uint32_t>::max();
    double seconds = std::numeric_limits<double>::infinity();

    bool reached(const capture::Reference& reference) const {
        return reference.samples >= samples || reference.seconds >= seconds;
    }
    /// Samples of the next run: one at first, then about a second's worth.
    std::uint32_t run(const capture::Reference& reference, double sample_seconds) const {
        const double room = std::min(run_seconds, seconds - reference.seconds);
        const double fitting = sample_seconds > 0 ? std::floor(room / sample_seconds) : 1;
        const auto most = static_cast<double>(samples - reference.samples);
        return static_cast<std::uint32_t>(std::clamp(fitting, 1.0, most));
    }
};

void render(capture::Reference& reference, const capture::PathTracer& tracer, const Goal& goal,
            const fs::path& folder) {
    const EndSignals signals;
    Progress progress;
    const bool by_samples = goal.seconds == std::numeric_limits<double>::infinity();
    const std::uint64_t pixels = reference.pixels.size();
    double saved_at = reference.seconds, sample_seconds = 0;
    bool unsaved = false;
    while (!goal.reached(reference) && !interrupted) {
        const double before = reference.seconds;
        const std::uint32_t run = goal.run(reference, sample_seconds), done = reference.samples;
        reference.add(tracer, run, [&](std::uint64_t finished) {
            if (by_samples)
                progress.update("path tracing", "samples", done * pixels + finished * run,
                                goal.samples * pixels);
        });
        if (!by_samples)
            progress.update("path tracing", "ms",
                            static_cast<std::uint64_t>(1000 * std::min(reference.seconds, goal.seconds)),
                            static_cast<std::uint64_t>(1000 * goal.seconds));
        sample_seconds = (reference.seconds - before) / run;
        unsaved = true;
        if (reference.seconds - saved_at >= save_every_seconds) {
            save(reference, folder);
            saved_at = reference.seconds;
            unsaved = false;
        }
    }
    if (unsaved) save(reference, folder);
    if (reference.samples > 0) write_images(reference, folder);
}

std::string report(const capture::Reference& reference, const fs::path& folder) {
    const double noise = std::sqrt(reference.mean_variance()), mean = reference.mean_radiance();
    std::string text =
        fmt::format("{}: {} x {} pixels, {} samples a pixel in {:.1f} s\n", reference.key.scene,
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

void run(const Options& options) {
    const Goal goal{
        options.samples.value_or(options.seconds ? std::numeric_limits<std::uint32_t>::max() : 256),
        options.seconds.value_or(std::numeric_limits<double>::infinity())};
    if (!(goal.seconds > 0))
        throw trace::UsageError(fmt::format("--seconds: found {}, expected more than 0", goal.seconds));
    scenes::Scene scene = scenes::load_scene(options.scene);
    if (options.frame) scene.camera = scenes::camera_at(scene, *options.frame);
    capture::Reference reference = capture::resume_reference(
        options.folder, {scene.name, capture::checksum(scene), options.width, options.height, options.seed});
    const capture::RayCaster caster(scene);
    const capture::LightSampler lights(scene);
    const capture::PathTracer tracer(
        scene, caster, lights, {.width = options.width, .height = options.height, .seed = options.seed});
    render(reference, tracer, goal, options.folder);
    if (!goal.reached(reference))
        throw std::runtime_error(
            fmt::format("{}: interrupted: {} samples a pixel are there; the same command goes on",
                        options.folder.string(), reference.samples));
    fmt::print("{}", report(reference, options.folder));
}

}  // namespace

void add_reference(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "reference", "render a scene by path tracing: the truth that images are measured against");
    command->add_option("scene", options->scene, "an embedded scene's name or a scene file")->required();
    command
        ->add_option("-o,--output", options->folder,
                     "folder for reference.exr, variance.exr and the samples' state")
        ->required();
    command->add_option("--width", options->width, "image width [pixels]")
        ->check(CLI::Range(1u, 32768u))
        ->capture_default_str();
    command->add_option("--height", options->height, "image height [pixels]")
        ->check(CLI::Range(1u, 32768u))
        ->capture_default_str();
    command
        ->add_option("--samples", options->samples,
                     "samples a pixel in all, those of earlier runs included (256 without --seconds)")
        ->check(CLI::Range(1u, std::numeric_limits<std::uint32_t>::max()));
    command->add_option("--seconds", options->seconds, "time in all, that of earlier runs included")
        ->check(CLI::PositiveNumber);
    command->add_option("--frame", options->frame,
                        "of the scene's camera path; without: the standing camera");
    command->add_option("--seed", options->seed, "of all random numbers")->capture_default_str();
    command->footer(
        "Saves every 30 seconds and at Ctrl-C; the same command goes on from there.\n"
        "Examples:\n"
        "  regather reference room -o out/room-reference --width 128 --height 128 --samples 64\n"
        "  regather reference room -o out/room-reference --width 128 --height 128 --samples 1024\n"
        "  regather reference room -o out/long --seconds 3600");
    command->callback([options] { run(*options); });
}

}  // namespace regather::cli
