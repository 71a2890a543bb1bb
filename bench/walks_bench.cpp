// bench/walks_bench.cpp -- what recording a walk adds to a search, and how fast walks decode, for each form
// of walk: bits of a tree, and lists. The queries of bench/room.h; every run checks what it found or decoded
// against the searches without a listener.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <span>
#include <vector>

#include "bench/room_walks.h"
#include "spatial/list_walk.h"
#include "spatial/photons/block_hashing.h"
#include "spatial/photons/hashed_grid.h"
#include "spatial/photons/photon_bvh.h"
#include "spatial/photons/photon_grid.h"
#include "spatial/photons/photon_octree.h"
#include "spatial/walk.h"

namespace {

using namespace regather;
using bench::k, bench::room;

constexpr std::size_t most_queries = 50'000;

/// Some of the queries, in whole Hilbert order.
const std::vector<trace::Vec3>& points() {
    static const std::vector<trace::Vec3> instance = [] {
        std::vector<trace::Vec3> some;
        const std::vector<std::uint32_t> order = room().permutation("hilbert");
        for (std::size_t i = 0; i < order.size() && some.size() < most_queries; i += 4)
            some.push_back(room().queries.position[order[i]]);
        return some;
    }();
    return instance;
}

template <class Index>
const Index& index() {
    static const Index instance = [] {
        if constexpr (std::same_as<Index, spatial::PhotonKd>)
            return Index(room().heap);
        else if constexpr (std::same_as<Index, spatial::BucketKd>)
            return Index(room().heap, {.rule = spatial::SplitRule::median, .leaf_photons = 8, .radius = 0});
        else if constexpr (std::same_as<Index, spatial::BlockHashing>)
            return Index(room().heap, {});
        else
            return Index(room().heap, 8);
    }();
    return instance;
}

/// The sum of the squared distances found, so that no search is left out.
template <class Index, class Listener>
double search_all(Listener&& listener) {
    spatial::NearestSet found(k);
    double sum = 0;
    for (const trace::Vec3 point : points()) {
        spatial::nearest(index<Index>(), point, found, listener);
        if constexpr (requires { listener.finish(); }) listener.finish();
        sum += found.disc_radius2();
    }
    return sum;
}

/// What every search has to find: in an exact structure, what the left-balanced tree's does.
template <class Index>
double distances() {
    constexpr bool is_exact = !std::same_as<Index, spatial::BlockHashing>;
    return search_all<std::conditional_t<is_exact, spatial::PhotonKd, Index>>(spatial::Unheard());
}

void rate(benchmark::State& state) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points().size()));
}

template <class Index>
void search(benchmark::State& state) {
    const double expected = distances<Index>();
    search_all<Index>(spatial::Unheard());
    for (auto unused : state)
        if (search_all<Index>(spatial::Unheard()) != expected) state.SkipWithError("other photons");
    rate(state);
}

template <class Index, class Walk>
void record(benchmark::State& state) {
    const double expected = distances<Index>();
    Walk recorder;
    for (auto unused : state) {
        recorder.clear();
        if (search_all<Index>(recorder) != expected) state.SkipWithError("other photons");
    }
    rate(state);
    state.counters["visits/query"] =
        static_cast<double>(recorder.visited_nodes()) / static_cast<double>(points().size());
    state.counters["bytes/query"] =
        static_cast<double>(recorder.bytes().size()) / static_cast<double>(points().size());
}

/// The walks of an index's searches, as `Tree` decodes them: a heap's, or the index's own structure.
template <class Index, class Walk, class Tree = void>
void decode(benchmark::State& state) {
    Walk recorder;
    std::vector<std::uint32_t> lengths;
    spatial::NearestSet found(k);
    for (const trace::Vec3 point : points()) {
        spatial::nearest(index<Index>(), point, found, recorder);
        lengths.push_back(recorder.finish());
    }
    const auto decoder = [] {
        if constexpr (!std::is_void_v<Tree>) {
            static const Tree tree(bench::photon_count);
            return tree.decoder();
        } else if constexpr (std::same_as<Index, spatial::BucketKd>) {
            return index<Index>().shape().decoder();
        } else {
            return index<Index>().share_structure()->decoder();
        }
    }();
    const auto decode_all = [&] {
        std::uint64_t visits = 0, start = 0;
        for (const std::uint32_t length : lengths) {
            visits += decoder->decode(recorder.bytes().subspan(start, length)).elements.size();
            start += length;
        }
        return visits;
    };
    const std::uint64_t expected = decode_all();
    // Who searches without a stack comes back to parents.
    const bool as_recorded = expected == recorder.visited_nodes();
    if (as_recorded == std::same_as<Tree, spatial::StackFree>)
        state.SkipWithError("another number of visits");
    for (auto unused : state)
        if (decode_all() != expected) state.SkipWithError("another number of visits");
    state.counters["visits/query"] = static_cast<double>(expected) / static_cast<double>(points().size());
    state.counters["visits/s"] =
        benchmark::Counter(static_cast<double>(expected), benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(search<spatial::PhotonKd>)->Unit(benchmark::kMillisecond);
BENCHMARK(record<spatial::PhotonKd, spatial::WalkRecorder>)->Unit(benchmark::kMillisecond);
BENCHMARK(decode<spatial::PhotonKd, spatial::WalkRecorder, spatial::LeftBalanced>)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(decode<spatial::PhotonKd, spatial::WalkRecorder, spatial::StackFree>)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(search<spatial::BucketKd>)->Unit(benchmark::kMillisecond);
BENCHMARK(record<spatial::BucketKd, spatial::WalkRecorder>)->Unit(benchmark::kMillisecond);
BENCHMARK(decode<spatial::BucketKd, spatial::WalkRecorder>)->Unit(benchmark::kMillisecond);
BENCHMARK(search<spatial::PhotonGrid>)->Unit(benchmark::kMillisecond);
BENCHMARK(record<spatial::PhotonGrid, spatial::ListWalkRecorder>)->Unit(benchmark::kMillisecond);
BENCHMARK(decode<spatial::PhotonGrid, spatial::ListWalkRecorder>)->Unit(benchmark::kMillisecond);
BENCHMARK(search<spatial::HashedGrid>)->Unit(benchmark::kMillisecond);
BENCHMARK(record<spatial::HashedGrid, spatial::ListWalkRecorder>)->Unit(benchmark::kMillisecond);
BENCHMARK(decode<spatial::HashedGrid, spatial::ListWalkRecorder>)->Unit(benchmark::kMillisecond);
BENCHMARK(search<spatial::PhotonOctree>)->Unit(benchmark::kMillisecond);
BENCHMARK(record<spatial::PhotonOctree, spatial::ListWalkRecorder>)->Unit(benchmark::kMillisecond);
BENCHMARK(decode<spatial::PhotonOctree, spatial::ListWalkRecorder>)->Unit(benchmark::kMillisecond);
BENCHMARK(search<spatial::PhotonBvh>)->Unit(benchmark::kMillisecond);
BENCHMARK(record<spatial::PhotonBvh, spatial::ListWalkRecorder>)->Unit(benchmark::kMillisecond);
BENCHMARK(decode<spatial::PhotonBvh, spatial::ListWalkRecorder>)->Unit(benchmark::kMillisecond);
BENCHMARK(search<spatial::BlockHashing>)->Unit(benchmark::kMillisecond);
BENCHMARK(record<spatial::BlockHashing, spatial::ListWalkRecorder>)->Unit(benchmark::kMillisecond);
BENCHMARK(decode<spatial::BlockHashing, spatial::ListWalkRecorder>)->Unit(benchmark::kMillisecond);

/// What is brought: visits that lie in memory. Here the left-balanced tree's, whose elements jump most.
struct Brought {
    std::vector<std::uint32_t> visits, counts, lengths;
    spatial::ListWalkRecorder recorder;

    Brought() {
        const replay::WalkStore walks = bench::walks();
        const auto decoder = walks.structure().decoder();
        for (std::uint64_t q = 0; q < walks.queries(); ++q) {
            const auto elements = decoder->decode(walks.walk(q)).elements;
            visits.insert(visits.end(), elements.begin(), elements.end());
            counts.push_back(static_cast<std::uint32_t>(elements.size()));
            for (const std::uint32_t element : elements) recorder.visit(element);
            lengths.push_back(recorder.finish());
        }
    }
};
const Brought& brought() {
    static const Brought instance;
    return instance;
}

void visits_rate(benchmark::State& state) {
    const auto visits = static_cast<double>(brought().visits.size());
    state.counters["visits/s"] = benchmark::Counter(visits, benchmark::Counter::kIsIterationInvariantRate);
    state.counters["bytes/visit"] = static_cast<double>(brought().recorder.bytes().size()) / visits;
}

void decode_brought(benchmark::State& state) {
    spatial::ListWalkDecoder decoder(bench::tree()->end());
    const std::span<const std::uint8_t> bytes = brought().recorder.bytes();
    for (auto unused : state) {
        std::uint64_t visits = 0, start = 0;
        for (const std::uint32_t length : brought().lengths) {
            visits += decoder.decode(bytes.subspan(start, length)).elements.size();
            start += length;
        }
        if (visits != brought().visits.size()) state.SkipWithError("another number of visits");
    }
    visits_rate(state);
}
BENCHMARK(decode_brought)->Unit(benchmark::kMillisecond);

void record_brought(benchmark::State& state) {
    for (auto unused : state) {
        spatial::ListWalkRecorder recorder;
        std::size_t next = 0, bytes = 0;
        for (const std::uint32_t count : brought().counts) {
            for (const std::uint32_t element : std::span(brought().visits).subspan(next, count))
                recorder.visit(element);
            next += count;
            bytes += recorder.finish();
            if (recorder.bytes().size() > 1 << 20) recorder.clear();
        }
        if (bytes != brought().recorder.bytes().size()) state.SkipWithError("other walks");
    }
    visits_rate(state);
}
BENCHMARK(record_brought)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
