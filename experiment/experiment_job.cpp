#include "experiment/experiment_job.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiment/parts.h"
#include "experiment/traces/structure_job.h"
#include "results/benefit.h"
#include "trace/folder.h"

namespace regather::experiment {
namespace {

namespace fs = std::filesystem;

/// "median-kd:leaf=8,found=1" as the name of a folder.
std::string folder_name(std::string structure) {
    for (const char separator : {':', ',', '='})
        std::replace(structure.begin(), structure.end(), separator, '-');
    return structure;
}

/// The trace of a captured frame's queries in a structure: the captured one, or another that is kept, or made
/// where it is missing, damaged or of another capture.
fs::path walked(const fs::path& frame, const std::string& structure, const ProgressListener& progress) {
    const StructureJob job{.trace = frame / "trace",
                           .folder = frame / "walks" / folder_name(structure),
                           .structure = structure,
                           .force = true};
    if (trace::TraceReader(job.trace).info().structure == structure) return job.trace;
    if (!is_done(job))
        run(job, [&](std::string_view stage, std::string_view unit, std::uint64_t done, std::uint64_t total) {
            if (progress) progress(fmt::format("{} in {}", stage, structure), unit, done, total);
        });
    return job.folder;
}

}  // namespace

ExperimentResult run(const ExperimentJob& job, const ProgressListener& progress) {
    const trace::FolderLock lock(job.folder);
    const CaptureResult captured = run({job.experiment.scene, job.experiment.capture, reads(job.experiment),
                                        job.folder, job.force, job.note},
                                       progress);
    if (job.captured) job.captured(captured);
    ExperimentResult result{captured.folders, {}, {}, {}};
    for (const fs::path& frame : captured.folders) {
        for (const Searched& searched : job.experiment.searched) {
            trace::TraceReader trace(walked(frame, searched.structure, progress));
            for (results::Row& row :
                 rows_of(trace, searched.layouts, job.experiment, {frame / "parts", job.revision}, progress))
                result.rows.push_back(std::move(row));
            result.checksums.push_back(trace.checksum());
        }
        result.parameters = trace::TraceReader(frame / "trace").info().parameters;
    }
    if (result.folders.size() > 1) result.parameters["frame"] = job.experiment.capture.frames;
    results::fill_net_benefit(result.rows);
    return result;
}

}  // namespace regather::experiment
