// study/convergence_job.h -- error against run time, from a scene's name to the folder: reference, rows,
// strips. What is there already is not measured again.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "capture/reference/reference.h"
#include "experiment/progress.h"
#include "results/convergence_row.h"
#include "study/convergence.h"

namespace regather::study {

struct ConvergenceJob {
    std::string scene;
    std::filesystem::path folder;
    std::filesystem::path reference;  ///< A folder; empty: FOLDER/reference, rendered when there is none.
    std::filesystem::path ladder;     ///< A CSV of settings; empty: the built-in ladders.
    double seconds = 120;             ///< About how long it may take, the reference included.
    std::optional<std::uint32_t> width, height, frame;  ///< [pixels]; none: the reference's, or 64.
    std::uint32_t seeds = 4, shadow_rays = 16;
    bool force = false;  ///< Measure again what the folder holds.
    experiment::NoteListener note = {};
};

struct Converged {
    std::string scene;
    std::string renderer;  ///< capture::fingerprint() of the scene.
    capture::Reference reference;
    ConvergenceConfig config;
    double mean_radiance = 0, reference_rmse = 0;  ///< Over the pixels that count.
    std::vector<results::ConvergenceRow> rows;     ///< Those that were there first.
    std::size_t known = 0;                         ///< So many were there.
    std::size_t settings = 0, skipped = 0;         ///< Of the ladder; did not fit into the time.
    std::filesystem::path csv;
};

/// Told after each setting with all rows so far, which then are in the folder but for their provenance.
using RowsWritten = std::function<void(const Converged& so_far)>;

/// A listener that throws ends it with the rows of all finished settings kept, and the reference's samples.
/// Throws trace::UsageError when the folder holds rows of something else.
Converged run(const ConvergenceJob& job, const experiment::ProgressListener& progress,
              const RowsWritten& written);

}  // namespace regather::study
