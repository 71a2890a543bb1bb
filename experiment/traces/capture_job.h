// experiment/traces/capture_job.h -- a capture from a scene's name to the files: OUT/image.exr,
// OUT/image.png, OUT/trace/ and, where there is a caustic map, OUT/caustic-trace/; with frames, the same in
// OUT/frame-0000/, OUT/frame-0005/ ...
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiment/progress.h"
#include "experiment/traces/capture_options.h"
#include "reorder/ordering.h"

namespace regather::experiment {

struct CaptureJob {
    std::string scene;
    CaptureOptions options;
    std::optional<reorder::Reads> reads;  ///< Columns that will be looked at; nothing: store them all.
    std::filesystem::path folder;
    bool force = false;
    NoteListener note = {};
};

struct CaptureResult {
    std::string report;                          ///< For people: several lines with figures and file names.
    std::vector<std::filesystem::path> folders;  ///< One a frame; each holds image and traces.
};

/// Of its camera path; 0 when it has none.
std::uint32_t frames_of(const scenes::Scene& scene);

/// Keeps a finished capture of the same scene and parameters. A finished one of others: trace::UsageError,
/// unless `force`.
CaptureResult run(const CaptureJob& job, const ProgressListener& progress);

}  // namespace regather::experiment
