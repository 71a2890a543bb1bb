// experiment/experiment_job.h -- an experiment from its file to its rows: OUT as a capture fills it
// (experiment/traces/capture_job.h), and of each frame the walks in other structures in OUT/walks/ or
// OUT/frame-0005/walks/, and the finished parts in OUT/parts/ or OUT/frame-0005/parts/.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "experiment/progress.h"
#include "experiment/traces/capture_job.h"
#include "results/row.h"
#include "trace/json.h"

namespace regather::experiment {

struct ExperimentJob {
    const Experiment& experiment;
    std::filesystem::path folder;
    std::string revision;  ///< Of the code: parts of another one are made again.
    bool force = false;    ///< Capture again over another capture.
    NoteListener note = {};
    std::function<void(const CaptureResult&)> captured = {};  ///< Told once, before the replays.
};

struct ExperimentResult {
    std::vector<std::filesystem::path> folders;  ///< One a frame.
    std::vector<results::Row> rows;      ///< Frame by frame, structure by structure, with net benefits.
    std::vector<std::string> checksums;  ///< Of the traces replayed, in the order of the rows.
    trace::Json parameters;              ///< Of the capture.
};

/// What is finished is kept and not made again; a listener that throws ends it. Holds the folder's lock.
ExperimentResult run(const ExperimentJob& job, const ProgressListener& progress);

}  // namespace regather::experiment
