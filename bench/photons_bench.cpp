// bench/photons_bench.cpp -- one million photons of `room`: tracing them, and building the left-balanced
// tree. On all cores; seconds of CPU are those of all threads.
#include <benchmark/benchmark.h>

#include "capture/photon_pass.h"
#include "scenes/loader.h"
#include "spatial/photons/photon_kd.h"

namespace regather::bench {
namespace {

constexpr std::uint32_t photon_count = 1'000'000;

struct Room {
    scenes::Scene scene = scenes::load_scene("room");
    capture::RayCaster caster{scene};
    capture::LightSampler lights{scene};
    capture::PhotonPass trace() const {
        return capture::trace_photons(scene, caster, lights, {.photons = photon_count, .seed = 1});
    }
};
const Room& room() {
    static const Room instance;
    return instance;
}

void photon_pass(benchmark::State& state) {
    const Room& in = room();
    for (auto _ : state) {
        const capture::PhotonPass pass = in.trace();
        if (pass.photons.size() != photon_count) state.SkipWithError("not all photons were stored");
    }
    state.SetItemsProcessed(state.iterations() * photon_count);
}
BENCHMARK(photon_pass)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime()->Iterations(3);

void left_balanced(benchmark::State& state) {
    const capture::PhotonPass pass = room().trace();
    for (auto _ : state) {
        const std::vector<trace::Photon> heap = spatial::left_balanced(pass.photons);
        state.PauseTiming();
        if (spatial::first_disorder(spatial::PhotonKd(heap)) != heap.size())
            state.SkipWithError("the tree is out of order");
        state.ResumeTiming();
    }
    state.SetItemsProcessed(state.iterations() * photon_count);
}
BENCHMARK(left_balanced)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Iterations(5);

}  // namespace
}  // namespace regather::bench

BENCHMARK_MAIN();
