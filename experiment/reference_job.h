// experiment/reference_job.h -- a path-traced reference, from a scene's name to the folder: taken up where it
// stopped, saved again and again, until it has the samples or the seconds that were asked for.
#pragma once
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "capture/reference/reference.h"
#include "experiment/progress.h"
#include "scenes/scene.h"

namespace regather::experiment {

/// Samples a pixel, seconds, or whichever comes first; both with those of earlier runs.
struct ReferenceGoal {
    std::uint32_t samples = std::numeric_limits<std::uint32_t>::max();
    double seconds = std::numeric_limits<double>::infinity();

    bool reached(const capture::Reference& reference) const {
        return reference.samples >= samples || reference.seconds >= seconds;
    }
};

struct ReferenceJob {
    std::string scene;
    std::filesystem::path folder;
    std::uint32_t width = 512, height = 512;
    std::uint64_t seed = 1;
    std::optional<std::uint32_t> frame;  ///< Of the camera path; none: the standing camera.
    ReferenceGoal goal;
    NoteListener note = {};
};

/// Renders until the goal is reached, in runs of about a second; saves the first samples, then every 30
/// seconds, at the end, and when the listener throws, which is then thrown on. At least 2 samples when
/// `least_samples` says so.
void render(capture::Reference& reference, const scenes::Scene& scene, const ReferenceGoal& goal,
            const std::filesystem::path& folder, const ProgressListener& progress,
            std::uint32_t least_samples = 1);

/// The whole job. Throws trace::UsageError when the folder holds a reference of another scene, size or seed.
capture::Reference run(const ReferenceJob& job, const ProgressListener& progress);

/// For people: several lines with figures and the file's name.
std::string report(const capture::Reference& reference, const std::filesystem::path& folder);

}  // namespace regather::experiment
