#include "cli/capture_options.h"

#include <fmt/format.h>

#include "trace/error.h"

namespace regather::cli {

void add_capture_options(Command& command, experiment::CaptureOptions& options) {
    using experiment::most_photons, experiment::most_pixels, experiment::most_rays, experiment::most_samples;
    const auto words = [](const auto& names) {
        return std::vector<std::string_view>(names.begin(), names.end());
    };
    command.option("--width", options.width, {1, most_pixels}, "image width [pixels]");
    command.option("--height", options.height, {1, most_pixels}, "image height [pixels]");
    command.option("--samples", options.samples, {1, most_samples},
                   "eye rays a pixel; one goes through its centre");
    command.choice("--mode", options.mode, words(capture::visualisation_names),
                   "how photons are seen: by final gather rays (equation 3), or direct (equation 2)");
    command.option("--gather-rays", options.gather_rays, {0, most_rays}, "final gather rays a pixel (N)");
    command.option("--shadow-rays", options.shadow_rays, {0, most_rays},
                   "shadow rays per shaded point and light, of up to four lights");
    command.option("--photons", options.photons, {0, most_photons}, "photons to store");
    command.option("--k", options.k, {1, most_photons}, "photons of a gather");
    command.option("--radius", options.radius, {.least = 0, .infinite = true},
                   "maximum radius of a gather [scene units]; 0 or inf: unlimited");
    command.choice("--filter", options.filter, words(capture::filter_names),
                   "weight of the photons of a gather by their distance");
    command.flag("--no-surface-check", options.surface_check,
                 "use photons of surfaces that face elsewhere, too", false);
    command.option("--caustic-photons", options.caustic_photons, {0, most_photons},
                   "photons of the caustic map; 0: no such map");
    command.option("--caustic-k", options.caustic_k, {1, most_photons},
                   "photons of a gather in the caustic map");
    command.option("--caustic-radius", options.caustic_radius, {.least = 0, .infinite = true},
                   "its maximum radius [scene units]; 0 or inf: unlimited");
    command.choice("--caustic-filter", options.caustic_filter, words(capture::filter_names), "its filter");
    command.comma_list(
        "--keep", options.keep,
        "parts to build although the scene has no need of them (regather info SCENE lists them)");
    command.option("--frames", options.frames,
                   "frames of the camera path: 7, or 0,10,20, or 0:30:5 (from, below, step)");
    command.option("--exposure", options.exposure, {.least = 0},
                   "of image.png: factor of the radiance; 0: by the image's mean");
    command.choice("--tone", options.tone, words(capture::tone_names), "tone curve of image.png");
    command.option("--seed", options.seed, {}, "of all random numbers");
    command.option("--gather-order", options.gather_order,
                   "ordering of the searches within a batch of pixels; changes the time, not the result");
    command.flag("--no-rays", options.rays, "leave the ray columns out", false);
}

void check_capture_options(const Command& command, const experiment::CaptureOptions& options) {
    if (options.mode == "direct")
        for (const char* name : {"--gather-rays", "--shadow-rays"})
            if (command.given(name))
                throw trace::UsageError(fmt::format(
                    "{}: found beside --mode direct, which casts no such rays, expected one of them", name));
    if (options.caustic_photons == 0)
        for (const char* name : {"--caustic-k", "--caustic-radius", "--caustic-filter"})
            if (command.given(name))
                throw trace::UsageError(fmt::format(
                    "{}: found beside --caustic-photons 0, which makes no such map, expected one of them",
                    name));
}

}  // namespace regather::cli
