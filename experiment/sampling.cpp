#include "experiment/sampling.h"

#include <fmt/format.h>

namespace regather::experiment {
namespace {

results::SamplingRow beside(const results::Row& row, const results::Row& exact, std::uint64_t seed) {
    return {.scene = row.scene,
            .ordering = row.ordering,
            .parameters = row.parameters,
            .cache_bytes = row.cache_bytes,
            .line_bytes = row.line_bytes,
            .ways = row.ways,
            .set_sampling = row.set_sampling,
            .seed = seed,
            .misses = row.misses,
            .misses_stderr = row.misses_stderr,
            .misses_low = row.misses_low,
            .misses_high = row.misses_high,
            .exact_misses = exact.misses,
            .covered = *row.misses_low <= *exact.misses && *exact.misses <= *row.misses_high,
            .seconds = row.replay_seconds,
            .exact_seconds = exact.replay_seconds};
}

}  // namespace

std::vector<results::SamplingRow> sampling(trace::TraceReader& trace, const SamplingRequest& request,
                                           const ProgressListener& progress) {
    for (const std::uint32_t rate : request.rates) replay::SetSample::check(request.caches, {rate, 1});
    Measurement exact(trace, request.orderings.reads, reorder::default_onchip_bytes),
        sampled(trace, request.orderings.reads, reorder::default_onchip_bytes);
    const auto shared = listening(progress, "counting what no order changes", "queries", exact.queries());
    exact.prepare(request.caches, {}, shared);
    sampled.prepare(request.caches, {.sampling = replay::Sampling{request.rates.front(), 1}}, shared);

    std::vector<results::SamplingRow> rows;
    for (const reorder::ParsedOrdering& parsed : request.orderings.all) {
        const reorder::Ordered ordered = exact.order(*parsed.ordering);
        const auto replaying = [&](const std::string& what) {
            return listening(progress, fmt::format("replaying {}{}", parsed.spec.text, what), "queries",
                             exact.queries());
        };
        const auto truth = exact.rows(parsed, ordered, request.caches, replaying(""));
        for (const std::uint32_t rate : request.rates)
            for (std::uint64_t seed = 1; seed <= request.seeds; ++seed) {
                sampled.sample({rate, seed});
                const auto found =
                    sampled.rows(parsed, ordered, request.caches, replaying(fmt::format(", 1/{}", rate)));
                for (std::size_t c = 0; c < found.size(); ++c)
                    rows.push_back(beside(found[c], truth[c], seed));
            }
    }
    return rows;
}

}  // namespace regather::experiment
