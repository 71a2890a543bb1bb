#include "experiment/experiment_job.h"

#include "experiment/parts.h"
#include "results/benefit.h"
#include "trace/folder.h"

namespace regather::experiment {

ExperimentResult run(const ExperimentJob& job, const ProgressListener& progress) {
    const trace::FolderLock lock(job.folder);
    const CaptureResult captured = run({job.experiment.scene, job.experiment.capture, reads(job.experiment),
                                        job.folder, job.force, job.note},
                                       progress);
    if (job.captured) job.captured(captured);
    ExperimentResult result{captured.folders, {}, {}, {}};
    for (const std::filesystem::path& folder : captured.folders) {
        trace::TraceReader trace(folder / "trace");
        for (results::Row& row : rows_of(trace, job.experiment, {folder / "parts", job.revision}, progress))
            result.rows.push_back(std::move(row));
        result.checksums.push_back(trace.checksum());
        result.parameters = trace.info().parameters;
    }
    if (result.folders.size() > 1) result.parameters["frame"] = job.experiment.capture.frames;
    results::fill_net_benefit(result.rows);
    return result;
}

}  // namespace regather::experiment
