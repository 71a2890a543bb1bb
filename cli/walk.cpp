// regather walk -- makes a trace of somebody else's photons and queries.
#include <memory>

#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "experiment/trace_job.h"

namespace regather::cli {

void add_walk(Command& command) {
    auto job = std::make_shared<experiment::TraceJob>();
    command
        .argument(
            "columns", job->columns,
            "folder with photon_position.npy and query_position.npy (float32, n x 3) and, if you have them, "
            "query_pixel.npy (uint32), query_direction.npy, query_weight.npy (float32, n x 3)")
        .required();
    command.option("-o,--output", job->folder, "the trace's folder").required();
    command.option("--k", job->k, {1, (1u << 31) - 1}, "photons of a search");
    command.option("--radius", job->radius, {.least = 0, .infinite = true},
                   "maximum radius [units of the positions]; 0 or inf: unlimited");
    command.option("--width", job->width, {1}, "image width that query_pixel counts with [pixels]");
    command.flag("--force", job->force, "overwrite a finished trace");
    command.footer("Example:\n  regather walk my_columns -o out/mine --k 50 --width 640");
    command.action(job, [](const experiment::TraceJob& asked, const Console& console) {
        std::string report;
        {
            Progress progress(console);
            report = experiment::run(asked, progress.listener());
        }
        console.print("{}", report);
    });
}

}  // namespace regather::cli
