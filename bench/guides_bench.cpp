// bench/guides_bench.cpp -- what it costs to guide the gather rays of a point, beside the gathers that they
// ask for: in `room` with 1 M photons, 100 searches of k = 100 with their radiance estimates; and one table,
// its own search included, with 100 rays drawn from it. A time is a point's, on one thread.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "bench/room.h"
#include "capture/sampling/gather_distribution.h"

namespace regather::bench {
namespace {

constexpr std::size_t rays = 100;

struct Guided {
    capture::Material surface;
    std::vector<capture::PhotonOrigin> origin;
    capture::PhotonGuide guide;

    explicit Guided(bool glossy)
        // Every photon is a witness: none is spared the work.
        : origin(room().heap.size(), capture::PhotonOrigin::surface),
          guide{spatial::PhotonKd(room().heap), origin, false, {}} {
        surface.diffuse = {0.5f, 0.5f, 0.5f};
        if (!glossy) return;
        surface.kind = capture::MaterialKind::glossy;
        surface.specular = {0.3f, 0.3f, 0.3f};
        surface.exponent = 50;
    }
    capture::GatherPoint at(std::size_t query) const {
        return {&surface, room().queries.normal[query], room().queries.normal[query]};
    }
};

/// Points some way apart; their gathers are the queries that follow, which are of one pixel.
std::size_t first_query(std::size_t point) {
    return point * 17 * rays % (room().queries.size() - rays);
}

void gathers(benchmark::State& state) {
    const Guided guided(false);
    spatial::NearestSet found(k);
    std::size_t point = 0;
    for (auto _ : state) {
        const std::size_t first = first_query(point++);
        capture::Vec3 all{};
        for (std::size_t i = first; i < first + rays; ++i) {
            spatial::nearest(guided.guide.photons, room().queries.position[i], found);
            all += capture::reflected_radiance(guided.guide.photons, found, guided.at(i),
                                               capture::Filter::none, true);
        }
        if (!trace::is_finite(all) || !found.full()) state.SkipWithError("a gather found no light");
    }
}
BENCHMARK(gathers)->Unit(benchmark::kMicrosecond);

void guides(benchmark::State& state, const char* spec, bool glossy) {
    const Guided guided(glossy);
    const auto distribution = capture::parse_sampling(spec).make(guided.guide);
    const capture::Strata strata(rays);
    std::size_t point = 0;
    for (auto _ : state) {
        const std::size_t query = first_query(point++);
        distribution->look({guided.at(query), room().queries.position[query], {}});
        double weights = 0;
        for (std::uint32_t ray = 0; ray < rays; ++ray) {
            capture::Sampler sampler(1, capture::Stream::gather, point, ray);
            const capture::Strata::Point place = strata.sample(ray, sampler);
            capture::GatherSample sample;
            if (distribution->sample(place, sampler, sample)) weights += 1 / sample.divisor;
        }
        if (!std::isfinite(weights)) state.SkipWithError("a ray has no density");
    }
}
BENCHMARK_CAPTURE(guides, cosine, "cosine", false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(guides, incident, "incident", false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(guides, incident_k100, "incident:k=100", false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(guides, combined, "combined", true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(guides, mis, "mis", true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(guides, lobes, "lobes", false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(guides, lobes_k100, "lobes:k=100", false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(guides, footprints, "footprints", false)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace regather::bench

BENCHMARK_MAIN();
