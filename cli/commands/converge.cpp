// regather converge -- error against run time: renders a ladder of settings for a while and measures each
// against a reference.
#include <fmt/format.h>

#include <memory>

#include "charts/chart.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "results/ladder.h"
#include "results/provenance.h"
#include "study/convergence_job.h"
#include "trace/text.h"

namespace regather::cli {
namespace {

study::Converged measure(const study::ConvergenceJob& job, const Console& console) {
    const Interruption interruption;
    std::size_t finished = 0;
    try {
        Progress progress(console);
        study::ConvergenceJob noted = job;
        noted.note = progress.note_listener();
        return study::run(
            noted, interruption.ending(progress.listener()), [&](const study::Converged& so_far) {
                finished = so_far.rows.size();
                results::write_provenance(
                    so_far.csv, provenance(console, ""),
                    trace::Json::object(
                        {{"reference_samples", so_far.reference.samples},
                         {"reference_rmse", so_far.reference_rmse},
                         {"scene_checksum", so_far.reference.key.scene_checksum},
                         {"renderer", trace::Json::object(
                                          {{"scene", so_far.scene}, {"fingerprint", so_far.renderer}})}}));
            });
    } catch (const Interrupted& interrupted) {
        throw Interrupted(
            interrupted.signal,
            fmt::format("{}: interrupted: the reference's samples and {} measured settings are there; the "
                        "same command goes on",
                        job.folder.string(), finished));
    }
}

void run_convergence(const study::ConvergenceJob& job, const Console& console) {
    const study::Converged made = measure(job, console);
    console.print("{}, {} x {} pixels, {} seeds; % of the mean radiance {:.4g} W / (m^2 sr)\n",
                  trace::shown(made.scene), made.config.width, made.config.height, made.config.seeds,
                  made.mean_radiance);
    console.print("reference: {} samples a pixel in {:.1f} s, own RMSE {:.3g} %; no error below it is told\n",
                  made.reference.samples, made.reference.seconds,
                  100 * made.reference_rmse / (made.mean_radiance > 0 ? made.mean_radiance : 1));
    const results::Table times = results::time_table(made.rows);
    const results::Table rays = results::equal_error_table(made.rows);
    console.print("{}{}{}", results::text_of(results::convergence_table(made.rows)),
                  times.empty() ? "" : '\n' + results::text_of(times),
                  rays.empty() ? "" : '\n' + results::text_of(rays));
    if (made.known > 0) console.print("{} of {} settings were there already\n", made.known, made.rows.size());
    if (made.skipped > 0)
        console.print("{} of {} settings did not fit into the time; the same command goes on with them\n",
                      made.skipped, made.settings);
    for (const auto& drawn : charts::write_charts(job.folder / "charts", results::Rows(made.rows), {}, {}))
        console.print("{}\n", drawn.files.empty()
                                  ? fmt::format("{}: not drawn: {}", drawn.kind, drawn.skipped)
                                  : drawn.files.back().string());
    console.print("strips: {}\nrows: {}\n", (job.folder / "strips").string(), made.csv.string());
}

}  // namespace

void add_converge(Command& command) {
    auto job = std::make_shared<study::ConvergenceJob>();
    command.argument("scene", job->scene, "an embedded scene's name or a scene file").required();
    command.option("-o,--output", job->folder, "folder for converge.csv, charts/, strips/ and reference/")
        .required();
    command.option("--seconds", job->seconds, {.least = 0, .above = true},
                   "about how long it may take; two fifths are for the reference when there is none");
    command.option("--width", job->width, {1, 4096}, "image width [pixels]; without: the reference's, or 64");
    command.option("--height", job->height, {1, 4096}, "image height [pixels]; without: the width");
    command.option("--reference", job->reference,
                   "a folder of `regather reference`; without: one is rendered");
    command.option("--ladder", job->ladder,
                   "a CSV of settings (docs/converge.md); without: the built-in ladders");
    command.option("--seeds", job->seeds, {1, 1000}, "images of each setting");
    command.option("--shadow-rays", job->shadow_rays, {0, 1u << 20}, "per light and shaded point");
    command.option("--frame", job->frame, {}, "of the scene's camera path; without: the standing camera");
    command.flag("--force", job->force, "measure again what the folder holds");
    command.footer(
        "A setting that is in the folder's CSV already is not measured again; SIGINT (Ctrl-C) and SIGTERM "
        "leave what is\n"
        "finished.\nExamples:\n"
        "  regather converge box -o out/box-converge --seconds 120\n"
        "  regather converge room -o out/room-converge --width 128 --reference out/room-reference --seconds "
        "600");
    command.action(job, run_convergence);
}

}  // namespace regather::cli
