#include "study/computation/computation_job.h"

#include <fmt/format.h>

#include <span>

#include "experiment/traces/one_capture.h"
#include "study/computation/estimate.h"
#include "study/computation/sampling_operations.h"
#include "trace/error.h"

namespace regather::study {
namespace {

constexpr double most_factor = 1000;

/// What the printed figures of Table 2 are made of.
std::vector<std::string> notes_on_the_print() {
    const Operations rows = operations(Computation()), print = operations(printed_computation());
    const auto a_eye_ray = [](const Operations& of) { return of.rays() / of.eye_rays; };
    return {fmt::format(
                "The rows make {:.0f} rays, {} an eye ray (1 eye, 16 shadow, 100 gather), and {:.1f} GFLOP.",
                rows.rays(), a_eye_ray(rows), rows.total() / 1e9),
            fmt::format(
                "Printed are 187170816 rays, {} an eye ray: they need 102 gather rays where the row has 100.",
                a_eye_ray(print)),
            fmt::format(
                "Printed are 321 GFLOP of BRDF evaluations: they need 102 gathers an eye ray ({:.1f}) where "
                "the row has 101 ({:.1f}).",
                print.gathers / 1e9, rows.gathers / 1e9),
            fmt::format("3.37 and 112 GFLOP follow from the printed rays, 437 ({:.1f}) from all three.",
                        print.total() / 1e9)};
}

void overlay(std::span<const GivenValue> settings, CountedValues& to) {
    for (const GivenValue& setting : settings) to.set(setting.input, setting.value, "--set");
}

std::vector<std::string> notes_on(const CaptureTraces& traces) {
    std::vector<std::string> notes;
    const trace::TraceInfo& info = traces.photons->info();
    if (traces.caustic_photons)
        notes.push_back(fmt::format("caustic map: {} queries of {}", traces.caustic_photons->info().queries,
                                    traces.caustic_photons->folder().string()));
    else if (info.parameters.find("caustic"))
        notes.push_back("caustic map: its trace is not here, so its gathers are not counted; name it, too");
    else
        notes.push_back("caustic map: the capture has none");
    if (traces.rays.empty())
        notes.push_back(
            "triangles and nodes a ray: not counted by a capture, Table 2's stand; name traces of regather "
            "walk "
            "--rays KIND");
    return notes;
}

}  // namespace

ComputationResult run(const ComputationJob& job, const experiment::ProgressListener& progress) {
    if (!(job.factor > 1 && job.factor <= most_factor))
        throw trace::UsageError(fmt::format("--factor: found {}, expected a number above 1, at most {}",
                                            job.factor, most_factor));
    if (!job.sampling.empty() && !job.traces.empty())
        throw trace::UsageError(
            "--sampling: found with traces, which tell their capture's; expected without, or --set "
            "table_flops,sample_flops");
    const std::vector<GivenValue> settings = parse_values(job.settings, "--set");
    std::vector<ComputationEstimate> estimates{{"paper", "", {}}};
    ComputationResult result;
    std::vector<std::string> notes;
    if (job.traces.empty()) {
        estimates.push_back({"paper-102", "", {printed_computation(), {}}});
        estimates.back().counted.set(Input::gather_rays, 102, "from the printed rays");
        estimates.back().counted.set(Input::gathers, 102, "from the printed GFLOP");
        const bool samples = !job.sampling.empty() && job.sampling != "all";
        if (!settings.empty() || samples) {
            estimates.push_back({"set", "", {}});
            if (samples) take_sampling(estimates.back().counted, job.sampling, 1);
            overlay(settings, estimates.back().counted);
        }
        notes = notes_on_the_print();
    } else {
        const CaptureTraces traces = open_traces(job.traces);
        const std::string& scene = traces.photons->info().scene;
        estimates.push_back({"counted", scene, counted_values(traces)});
        estimates.push_back({"measured", scene, measured_values(traces, progress)});
        for (ComputationEstimate& estimate : std::span(estimates).subspan(1))
            overlay(settings, estimate.counted);
        const std::vector<const trace::TraceReader*> all = traces.all();
        result.checksum = all.size() == 1 ? all.front()->checksum() : experiment::checksum_of(all);
        result.parameters = experiment::parameters_of(all, "computation");
        notes = notes_on(traces);
    }
    for (const ComputationEstimate& estimate : estimates)
        for (results::ComputationRow& row : sensitivity_of(estimate, job.factor))
            result.rows.push_back(std::move(row));
    result.tables.push_back(table_of_estimates(estimates));
    result.tables.back().notes = std::move(notes);
    result.tables.push_back(results::sensitivity_table(result.rows));
    if (!job.sampling.empty()) result.tables.push_back(sampling_operations(job.sampling));
    return result;
}

}  // namespace regather::study
