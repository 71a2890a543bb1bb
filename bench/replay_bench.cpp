// bench/replay_bench.cpp -- is replaying walks worth it? One ordering of the same queries: searched again, and replayed.
// The trace is made here: photons on the walls of a room, as many and as dense as `room` has at full scale; queries on the
// same walls. Every run checks the lines, nodes or misses that it counts against the searches'.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "cachesim/cache.h"
#include "cachesim/lines.h"
#include "replay/replay.h"
#include "reorder/catalogue.h"
#include "spatial/nearest.h"
#include "spatial/recording.h"
#include "spatial/walk.h"

namespace {

using namespace regather;
using trace::Vec3;

constexpr std::uint32_t photon_count = 1'000'000, query_count = 200'000, k = 100;

class Numbers {
public:
    explicit Numbers(std::uint64_t seed) : state_(seed) {}
    float uniform() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<float>(state_ >> 40) * 0x1p-24f;
    }

private:
    std::uint64_t state_;
};

/// On the six faces of a box of 10 x 8 x 3.
Vec3 on_walls(Numbers& numbers) {
    const Vec3 size{10, 8, 3};
    Vec3 p{numbers.uniform() * size.x, numbers.uniform() * size.y, numbers.uniform() * size.z};
    const float pick = numbers.uniform() * (80 + 30 + 24);
    const int axis = pick < 80 ? 2 : pick < 110 ? 1 : 0;
    p[axis] = numbers.uniform() < 0.5f ? 0.0f : size[axis];
    return p;
}

struct Room {
    std::vector<trace::Photon> heap;
    std::vector<Vec3> queries;
    spatial::Recording recording;

    Room() : queries(query_count) {
        Numbers numbers(1);
        std::vector<trace::Photon> photons(photon_count);
        for (trace::Photon& photon : photons) photon.position = on_walls(numbers);
        heap = spatial::left_balanced(photons);
        for (Vec3& query : queries) query = on_walls(numbers);
        recording = spatial::record_walks(spatial::PhotonKd(heap), queries, k, std::numeric_limits<float>::infinity());
    }
    std::vector<std::uint32_t> permutation(const char* ordering) const {
        std::vector<std::uint32_t> pixel(query_count);
        std::iota(pixel.begin(), pixel.end(), 0u);
        const reorder::Workload work{.position = queries, .direction = {}, .pixel = pixel, .leaf_kd = {}, .leaf_bvh = {},
                                     .bounds = trace::bounds_of(queries), .image_width = query_count, .image_height = 1};
        return reorder::order(*reorder::make_ordering(ordering), work).permutation;
    }
};

const Room& room() {
    static const Room instance;
    return instance;
}

constexpr std::array<const char*, 2> orderings{"naive", "hilbert"};

void rate(benchmark::State& state) {
    state.SetItemsProcessed(state.iterations() * query_count);
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
    const std::vector<std::uint32_t> order = room().permutation(orderings[static_cast<std::size_t>(state.range(0))]);
    const spatial::PhotonKd tree(room().heap);
    spatial::NearestSet found(k);
    for (auto unused : state) {
        std::uint64_t count = 0;
        for (const std::uint32_t q : order) {
            spatial::nearest(tree, room().queries[q], found);
            count += found.size();
        }
        if (count != room().recording.found_photons) state.SkipWithError("found another number of photons");
    }
    rate(state);
}
BENCHMARK(search_again)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void search_again_and_simulate(benchmark::State& state) {
    const std::vector<std::uint32_t> order = room().permutation(orderings[static_cast<std::size_t>(state.range(0))]);
    const spatial::PhotonKd tree(room().heap);
    const replay::WalkStore walks(photon_count, room().recording.walk_bytes, room().recording.walks);
    const std::array<cachesim::CacheConfig, 1> caches{};
    const std::uint64_t expected = replay::replay(walks, {}, order, caches).caches[0].misses;
    spatial::NearestSet found(k);
    for (auto unused : state) {
        Simulate simulate;
        for (const std::uint32_t q : order) {
            spatial::nearest(tree, room().queries[q], found, simulate);
            simulate.drain();
        }
        if (simulate.cache.total().misses != expected) state.SkipWithError("another number of misses than the replay");
    }
    rate(state);
}
BENCHMARK(search_again_and_simulate)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void decode(benchmark::State& state) {
    const std::vector<std::uint32_t> order = room().permutation(orderings[static_cast<std::size_t>(state.range(0))]);
    const replay::WalkStore walks(photon_count, room().recording.walk_bytes, room().recording.walks);
    for (auto unused : state) {
        const replay::Replayed replayed = replay::replay(walks, {}, order, {});
        if (replayed.visited_nodes != room().recording.visited_nodes) state.SkipWithError("another number of nodes");
    }
    rate(state);
    state.counters["nodes/s"] = benchmark::Counter(static_cast<double>(room().recording.visited_nodes),
                                                   benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(decode)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void replay_and_simulate(benchmark::State& state) {
    const std::vector<std::uint32_t> order = room().permutation(orderings[static_cast<std::size_t>(state.range(0))]);
    const replay::WalkStore walks(photon_count, room().recording.walk_bytes, room().recording.walks);
    const std::array<cachesim::CacheConfig, 1> caches{};
    double accesses = 0;
    for (auto unused : state) {
        const replay::Replayed replayed = replay::replay(walks, {}, order, caches);
        if (replayed.visited_nodes != room().recording.visited_nodes) state.SkipWithError("another number of nodes");
        accesses = static_cast<double>(replayed.caches[0].accesses);
    }
    rate(state);
    state.counters["accesses/s"] = benchmark::Counter(accesses, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(replay_and_simulate)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
