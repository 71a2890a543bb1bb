#include "study/computation/counters.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "capture/sampling/gather_distribution.h"
#include "experiment/traces/one_capture.h"
#include "replay/walk_run.h"
#include "replay/walk_store.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::study {
namespace {

namespace fs = std::filesystem;
using experiment::kind_of_rays;

std::string file_of(const trace::TraceReader& trace) {
    return trace::shown((trace.folder() / "trace.json").string(), trace::most_shown_path);
}

std::uint64_t counter_of(const trace::TraceReader& trace, const std::string& name, std::uint64_t least = 0) {
    const trace::Json* const found = trace.info().counts.find(name);
    if (found && found->is_whole() && *found->whole() >= least) return *found->whole();
    throw trace::DataError(
        fmt::format("{}: counts.{}: found {}, expected a whole number from {} up, as a "
                    "capture counts its rays",
                    file_of(trace), name, found ? trace::shown(found->dump()) : "nothing", least));
}

/// a / b; 0 of nothing.
double ratio(std::uint64_t a, std::uint64_t b) {
    return b == 0 ? 0 : static_cast<double>(a) / static_cast<double>(b);
}

/// The folder of a finished trace, or that in a capture's.
fs::path trace_of(const fs::path& folder) {
    std::error_code error;
    return !fs::exists(folder / "trace.json", error) && fs::is_directory(folder / "trace", error)
               ? folder / "trace"
               : folder;
}

/// Visits of all queries of a trace.
struct Visits {
    std::uint64_t nodes = 0, photons = 0, triangles = 0;
};

Visits visits_of(trace::TraceReader& trace, const experiment::ProgressListener& progress) {
    const replay::WalkStore walks(trace);
    const spatial::Structure& structure = walks.structure();
    const auto ranges = structure.ranges();
    tbb::enumerable_thread_specific<Visits> parts;
    replay::run_all_walks(
        walks, parts,
        experiment::listening(progress, "counting visits of " + experiment::part_name(trace.info()),
                              "queries", walks.queries()),
        [&](Visits& part, std::span<const std::uint32_t> elements) {
            for (const std::uint32_t element : elements) {
                const trace::Region region = ranges[spatial::range_at(ranges, element)].region;
                if (region == trace::Region::nodes) ++part.nodes;
                if (region == trace::Region::photons) part.photons += structure.records(element);
                if (region == trace::Region::triangles) part.triangles += structure.records(element);
            }
        });
    Visits all;
    for (const Visits& part : parts) {
        all.nodes += part.nodes;
        all.photons += part.photons;
        all.triangles += part.triangles;
    }
    return all;
}

/// All photons that the searches of a trace looked at. Of the tree of the capture each node is a photon.
std::uint64_t photons_looked_at(trace::TraceReader& trace, const experiment::ProgressListener& progress) {
    constexpr std::string_view photon_a_node = "left-balanced-kd";
    return trace.info().structure == photon_a_node ? trace.info().visited_nodes
                                                   : visits_of(trace, progress).photons;
}

/// Takes a value of the trace's, which its file answers for.
void take(CountedValues& to, Input input, double value, std::string source, const trace::TraceReader& trace) {
    try {
        check_value(input, value, source);
    } catch (const trace::UsageError& error) {
        throw trace::DataError(fmt::format("{}: {}", file_of(trace), error.what()));
    }
    to.set(input, value, std::move(source));
}

/// By the spec that the capture was made with, and how often it searched for a table.
void measure_sampling(CountedValues& to, const trace::TraceReader& trace) {
    const trace::Json* const spec = trace.info().parameters.find("sampling");
    const std::string given = spec && spec->text() ? *spec->text() : std::string(capture::default_sampling);
    try {
        const bool searches = capture::parse_sampling(given).cost(true).searches > 0;
        take_sampling(
            to, given,
            searches ? ratio(counter_of(trace, "guide_queries"), counter_of(trace, "eye_rays", 1)) : 1);
    } catch (const trace::UsageError& error) {
        throw trace::DataError(fmt::format("{}: {}", file_of(trace), error.what()));
    }
}

void measure_gathers(CountedValues& to, const CaptureTraces& traces,
                     const experiment::ProgressListener& progress) {
    std::uint64_t queries = 0, found = 0, looked_at = 0;
    for (trace::TraceReader* const trace : {traces.photons.get(), traces.caustic_photons.get()}) {
        if (trace == nullptr) continue;
        queries += trace->info().queries;
        found += trace->info().found_photons;
        looked_at += photons_looked_at(*trace, progress);
    }
    if (queries == 0) return;
    take(to, Input::found, ratio(found, queries), "found_photons / queries", *traces.photons);
    take(to, Input::looked_at, ratio(looked_at, queries),
         traces.photons->info().structure == "left-balanced-kd" ? "visited_nodes / queries"
                                                                : "walks of queries",
         *traces.photons);
}

void measure_rays(CountedValues& to, const CaptureTraces& traces,
                  const experiment::ProgressListener& progress) {
    if (traces.rays.empty()) return;
    double rays = 0, triangles = 0, nodes = 0;
    std::string walked, unwalked;
    for (const std::string_view kind : trace::ray_kinds) {
        const std::uint64_t count = counter_of(*traces.photons, fmt::format("{}_rays", kind));
        if (count == 0) continue;
        rays += static_cast<double>(count);
        const auto found = std::find_if(traces.rays.begin(), traces.rays.end(), [&](const auto& trace) {
            return *kind_of_rays(trace->info()) == kind;
        });
        std::string& names = found == traces.rays.end() ? unwalked : walked;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", kind);
        if (found == traces.rays.end()) {
            triangles += static_cast<double>(count) * to.values[Input::intersections];
            nodes += static_cast<double>(count) * to.values[Input::nodes];
            continue;
        }
        if ((*found)->info().queries != count)
            throw trace::DataError(fmt::format("{}: queries: found {}, expected {} as counts.{}_rays of {}",
                                               file_of(**found), (*found)->info().queries, count, kind,
                                               traces.photons->folder().string()));
        const Visits visits = visits_of(**found, progress);
        triangles += static_cast<double>(visits.triangles);
        nodes += static_cast<double>(visits.nodes);
    }
    if (walked.empty()) return;
    const std::string source =
        fmt::format("walks of {} rays{}", walked,
                    unwalked.empty() ? "" : fmt::format("; {} rays with Table 2's", unwalked));
    take(to, Input::intersections, triangles / rays, source, *traces.photons);
    take(to, Input::nodes, nodes / rays, source, *traces.photons);
}

}  // namespace

std::vector<const trace::TraceReader*> CaptureTraces::all() const {
    std::vector<const trace::TraceReader*> out{photons.get()};
    if (caustic_photons) out.push_back(caustic_photons.get());
    for (const auto& trace : rays) out.push_back(trace.get());
    return out;
}

CaptureTraces open_traces(std::span<const fs::path> folders) {
    CaptureTraces out;
    const auto refuse_second = [](const trace::TraceReader& second, const trace::TraceReader& first) {
        throw trace::UsageError(fmt::format("{}: found {} as in {}, expected each kind once",
                                            second.folder().string(), experiment::part_name(second.info()),
                                            first.folder().string()));
    };
    for (const fs::path& folder : folders) {
        auto trace = std::make_unique<trace::TraceReader>(trace_of(folder));
        if (const std::string* const kind = kind_of_rays(trace->info())) {
            for (const auto& other : out.rays)
                if (*kind_of_rays(other->info()) == *kind) refuse_second(*trace, *other);
            out.rays.push_back(std::move(trace));
            continue;
        }
        if (trace->info().map == "guide")
            throw trace::UsageError(fmt::format("{}: found {}, expected those that a pixel gathers",
                                                trace->folder().string(),
                                                experiment::part_name(trace->info())));
        auto& place = trace->info().map == trace::map_names[0] ? out.photons : out.caustic_photons;
        if (place) refuse_second(*trace, *place);
        place = std::move(trace);
    }
    if (!out.photons)
        throw trace::UsageError(fmt::format(
            "traces: found none whose queries search the {} photon map, expected the trace of a capture",
            trace::map_names[0]));
    const fs::path beside = out.photons->folder().parent_path() / "caustic-trace";
    std::error_code error;
    if (!out.caustic_photons && out.photons->folder().filename() == "trace" && fs::exists(beside, error))
        out.caustic_photons = std::make_unique<trace::TraceReader>(beside);
    for (const trace::TraceReader* const trace : out.all())
        experiment::check_one_capture(*out.photons, *trace, "the traces of a computation");
    return out;
}

void CountedValues::set(Input input, double value, std::string source) {
    values[input] = value;
    sources[static_cast<std::size_t>(input)] = std::move(source);
}

void take_sampling(CountedValues& to, std::string_view spec, double tables) {
    const capture::SamplingCost cost = capture::parse_sampling(spec).cost(true);
    const std::string source = fmt::format("operations of {}", spec);
    to.set(Input::table_flops, tables * cost.table.flop(), source);
    to.set(Input::sample_flops, cost.sample.flop(), source);
}

CountedValues counted_values(const CaptureTraces& traces) {
    const trace::TraceReader& trace = *traces.photons;
    const trace::TraceInfo& info = trace.info();
    CountedValues out;
    const std::uint64_t eye = counter_of(trace, "eye_rays", 1);
    const std::uint64_t pixels = std::uint64_t{info.image_width} * info.image_height;
    take(out, Input::pixels, static_cast<double>(pixels), "image_width x image_height", trace);
    take(out, Input::samples, ratio(eye, pixels), "counts.eye_rays / pixels", trace);
    for (const auto& [input, kind] :
         {std::pair(Input::specular_rays, "specular"), std::pair(Input::shadow_rays, "shadow"),
          std::pair(Input::gather_rays, "gather")})
        take(out, input, ratio(counter_of(trace, fmt::format("{}_rays", kind)), eye),
             fmt::format("counts.{}_rays / counts.eye_rays", kind), trace);
    const std::uint64_t caustic = traces.caustic_photons ? traces.caustic_photons->info().queries : 0;
    take(out, Input::gathers, ratio(info.queries, eye) + ratio(caustic, eye),
         traces.caustic_photons ? "queries of both maps / counts.eye_rays" : "queries / counts.eye_rays",
         trace);
    return out;
}

CountedValues measured_values(const CaptureTraces& traces, const experiment::ProgressListener& progress) {
    CountedValues out = counted_values(traces);
    measure_sampling(out, *traces.photons);
    measure_gathers(out, traces, progress);
    measure_rays(out, traces, progress);
    return out;
}

}  // namespace regather::study
