#include "experiment/trace_race.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiment/workload.h"
#include "replay/verification.h"
#include "spatial/photons/photon_kd.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::experiment {
namespace {

/// All of the trace's queries, or a contiguous part from the middle of the capture.
reorder::Workload raced(trace::TraceReader& trace, const reorder::Reads& reads, std::uint64_t asked_for) {
    const std::uint64_t all = trace.info().queries, wanted = asked_for == 0 ? all : asked_for;
    if (wanted > all)
        throw trace::UsageError(
            fmt::format("--queries: found {}, expected at most the trace's {}", wanted, all));
    if (wanted < all && reads.rows)
        throw trace::UsageError(fmt::format(
            "--queries: found {}, expected all {} of the trace where a file orders them", wanted, all));
    if (all == 0)
        throw trace::DataError(fmt::format("{}: found no queries, expected at least 1",
                                           (trace.folder() / "query_position.npy").string()));
    return middle_of(workload(trace, reads), wanted);
}

/// The place of naive among the orderings, which it joins as the first where it is missing.
std::size_t baseline_of(std::vector<reorder::ParsedOrdering>& orderings) {
    const auto naive =
        std::find_if(orderings.begin(), orderings.end(),
                     [](const reorder::ParsedOrdering& ordering) { return ordering.spec.text == "naive"; });
    if (naive != orderings.end()) return static_cast<std::size_t>(naive - orderings.begin());
    orderings.insert(orderings.begin(), reorder::parse_ordering("naive"));
    return 0;
}

results::RaceRow row_of(const Standing& standing, const reorder::OrderingSpec& spec,
                        const RaceConfig& config) {
    results::RaceRow row;
    row.structure = name(standing.structure);
    row.ordering = spec.name;
    row.tile = spec.tile;
    row.bins = spec.bins;
    row.parameters = spec.text;
    row.k = config.k;
    if (std::isfinite(config.radius)) row.radius = config.radius;
    row.gathered = config.gathered;
    row.threads = config.threads;
    row.repeats = config.repeats;
    row.order_seconds_median = standing.order.median;
    row.search_seconds_median = standing.search.median;
    row.search_seconds_min = standing.search.min;
    row.search_seconds_max = standing.search.max;
    row.search_seconds_mad = standing.search.mad;
    row.net_gain_seconds = standing.net_gain;
    return row;
}

}  // namespace

std::vector<results::RaceRow> race(trace::TraceReader& trace, TraceRace asked,
                                   const ProgressListener& progress) {
    std::vector<reorder::ParsedOrdering>& orderings = asked.orderings.all;
    const std::size_t baseline = baseline_of(orderings);
    const trace::TraceInfo& info = trace.info();
    const std::optional<float> radius = replay::search_radius(trace);
    if (!radius)
        throw trace::DataError(
            fmt::format("{}: parameters.radius: found nothing, expected the radius of the searches (null: "
                        "unlimited), which the race runs again",
                        trace::shown((trace.folder() / "trace.json").string(), trace::most_shown_path)));
    replay::refuse_normals(trace);
    const RaceConfig config{.k = asked.k == 0 ? info.k : asked.k,
                            .radius = *radius,
                            .repeats = asked.repeats,
                            .threads = asked.threads,
                            .gathered = asked.gathered,
                            .structures = asked.structures};
    const std::span<const trace::Photon> heap = trace.column<trace::Photon>("photon");
    const spatial::PhotonKd tree(heap);
    if (const std::uint32_t node = spatial::first_disorder(tree); node != tree.size())
        throw trace::DataError(fmt::format("{}: row {} breaks the order of a left-balanced kd-tree",
                                           (trace.folder() / "photon.npy").string(), node));
    const reorder::Workload work = raced(trace, asked.orderings.reads, asked.queries);
    const std::uint64_t queries = work.position.size();

    const Race result =
        race(heap, work, orderings, baseline, config, [&](std::uint64_t done, std::uint64_t total) {
            if (progress) progress("racing", "queries", done, total);
        });
    if (config.k == info.k && queries == info.queries && result.found_photons != info.found_photons)
        throw trace::DataError(
            fmt::format("{}: found_photons: found {}, expected {}, which the searches find",
                        (trace.folder() / "trace.json").string(), info.found_photons, result.found_photons));
    std::vector<results::RaceRow> rows;
    for (const Standing& standing : result.standings) {
        results::RaceRow& row =
            rows.emplace_back(row_of(standing, orderings[standing.ordering].spec, config));
        row.scene = info.scene;
        row.queries = queries;
        row.photons = info.photons;
    }
    return rows;
}

}  // namespace regather::experiment
