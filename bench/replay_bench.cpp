// bench/replay_bench.cpp -- is replaying walks worth it? One ordering of the same queries: searched again,
// and replayed. The trace is made here: the scene `room` with 1 M photons, k = 100 and the queries of 45 x 45
// pixels x 100 gather rays. Every run checks the photons, nodes or misses that it counts against the
// searches'.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "bench/room_walks.h"
#include "cachesim/cache.h"
#include "cachesim/lines.h"
#include "replay/first_touches.h"
#include "replay/replay.h"
#include "spatial/heap_walk.h"
#include "spatial/photons/nearest.h"

namespace {

using namespace regather;

using bench::k, bench::room;

constexpr std::array<const char*, 2> orderings{"naive", "hilbert"};

void rate(benchmark::State& state) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(room().queries.size()));
    state.SetLabel(orderings[static_cast<std::size_t>(state.range(0))]);
}

/// Simulates the lines of a search's visits.
struct Simulate {
    cachesim::LruCache cache{cachesim::CacheConfig{}};
    std::vector<cachesim::Line> lines;
    void visit(std::uint32_t node) { cachesim::append_lines(lines, std::uint64_t{node} * 20, 20, 128); }
    void near(bool) {}
    void far(bool) {}
    void drain() {
        cache.access(lines, trace::Region::photons);
        lines.clear();
    }
};

void search_again(benchmark::State& state) {
    const std::vector<std::uint32_t> order =
        room().permutation(orderings[static_cast<std::size_t>(state.range(0))]);
    const spatial::PhotonKd tree(room().heap);
    spatial::NearestSet found(k);
    for (auto unused : state) {
        std::uint64_t count = 0;
        for (const std::uint32_t q : order) {
            spatial::nearest(tree, room().queries.position[q], found);
            count += found.size();
        }
        if (count != room().recording.found_photons) state.SkipWithError("found another number of photons");
    }
    rate(state);
}
BENCHMARK(search_again)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void search_again_and_simulate(benchmark::State& state) {
    const std::vector<std::uint32_t> order =
        room().permutation(orderings[static_cast<std::size_t>(state.range(0))]);
    const spatial::PhotonKd tree(room().heap);
    const replay::WalkStore walks = bench::walks();
    const replay::Layout layout = bench::heap_20();
    const std::array<cachesim::CacheConfig, 1> caches{};
    const replay::ReplayConfig config{{caches.begin(), caches.end()}, false};
    const std::uint64_t expected =
        replay::replay(walks, layout, order, config, replay::count_revisits(walks, layout, config))
            .caches[0]
            .misses;
    spatial::NearestSet found(k);
    for (auto unused : state) {
        Simulate simulate;
        for (const std::uint32_t q : order) {
            spatial::nearest(tree, room().queries.position[q], found, simulate);
            simulate.drain();
        }
        if (simulate.cache.total().misses != expected)
            state.SkipWithError("another number of misses than the replay");
    }
    rate(state);
}
BENCHMARK(search_again_and_simulate)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void decode(benchmark::State& state) {
    const std::vector<std::uint32_t> order =
        room().permutation(orderings[static_cast<std::size_t>(state.range(0))]);
    const replay::WalkStore walks = bench::walks();
    const replay::Layout layout = bench::heap_20();
    for (auto unused : state) {
        const replay::Replayed replayed = replay::replay(walks, layout, order, {}, {});
        if (replayed.visited_nodes != room().recording.visited_nodes)
            state.SkipWithError("another number of nodes");
    }
    rate(state);
    state.counters["nodes/s"] = benchmark::Counter(static_cast<double>(room().recording.visited_nodes),
                                                   benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(decode)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void replay_and_simulate(benchmark::State& state) {
    const std::vector<std::uint32_t> order =
        room().permutation(orderings[static_cast<std::size_t>(state.range(0))]);
    const replay::WalkStore walks = bench::walks();
    const replay::Layout layout = bench::heap_20();
    const std::array<cachesim::CacheConfig, 1> caches{};
    const replay::ReplayConfig config{{caches.begin(), caches.end()}, false};
    const replay::Revisits revisits = replay::count_revisits(walks, layout, config);
    double accesses = 0;
    for (auto unused : state) {
        const replay::Replayed replayed = replay::replay(walks, layout, order, config, revisits);
        if (replayed.visited_nodes != room().recording.visited_nodes)
            state.SkipWithError("another number of nodes");
        accesses = static_cast<double>(replayed.caches[0].accesses);
    }
    rate(state);
    state.counters["accesses/s"] =
        benchmark::Counter(accesses, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(replay_and_simulate)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

/// What the orders share, on all cores: paid once.
void hold_first_touches(benchmark::State& state) {
    const replay::WalkStore walks = bench::walks();
    const replay::Layout layout = bench::heap_20();
    const std::array<std::uint32_t, 1> lines{128};
    std::uint64_t bytes = 0;
    for (auto unused : state) {
        const replay::FirstTouches held(walks, layout, lines, std::uint64_t{1} << 34);
        if (held.held_queries() != walks.queries()) state.SkipWithError("not all walks are held");
        bytes = held.bytes();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(walks.queries()));
    state.counters["bytes/query"] = static_cast<double>(bytes) / static_cast<double>(walks.queries());
}
BENCHMARK(hold_first_touches)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void replay_held_and_simulate(benchmark::State& state) {
    const std::vector<std::uint32_t> order =
        room().permutation(orderings[static_cast<std::size_t>(state.range(0))]);
    const replay::WalkStore walks = bench::walks();
    const replay::Layout layout = bench::heap_20();
    const replay::ReplayConfig config{{cachesim::CacheConfig{}}, false, true};
    const replay::ReplayConfig alone{config.caches, false};
    const replay::Revisits revisits = replay::count_revisits(walks, layout, config);
    const std::array<std::uint32_t, 1> lines{config.caches[0].line_bytes};
    const replay::FirstTouches held(walks, layout, lines, std::uint64_t{1} << 34);
    const std::uint64_t expected =
        replay::replay(walks, layout, order, alone, replay::count_revisits(walks, layout, alone))
            .caches[0]
            .misses;
    for (auto unused : state) {
        const replay::Replayed replayed = replay::replay(walks, layout, order, config, revisits, held);
        if (replayed.caches[0].misses != expected)
            state.SkipWithError("another number of misses than the replay that decodes");
    }
    rate(state);
}
BENCHMARK(replay_held_and_simulate)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
