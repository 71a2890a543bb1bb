// bench/family_bench.cpp -- every LRU cache from one pass, on the lines of `room` in naive and Hilbert order:
// 17 numbers of sets (1 to 2^16) x 16 ways, lines of 128 bytes. Against the fast simulator of one cache run
// 272 times. Each checks its misses.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <vector>

#include "bench/room_walks.h"
#include "cachesim/cache.h"
#include "cachesim/lru/lru_family.h"
#include "replay/walk_lines.h"
#include "replay/walk_store.h"
#include "spatial/heap_walk.h"

namespace {

using namespace regather;
using bench::photon_count, bench::room;
using cachesim::Line;

constexpr std::array<const char*, 2> orderings{"naive", "hilbert"};

/// All lines that the walks touch, in order, and where each walk starts.
struct Stream {
    std::vector<Line> lines;
    std::vector<std::size_t> start;
};

const Stream& stream(std::size_t ordering) {
    static const std::array<Stream, 2> streams = [] {
        std::array<Stream, 2> all;
        const replay::WalkStore walks = bench::walks();
        const replay::Layout layout = bench::heap_20();
        for (std::size_t o = 0; o < 2; ++o) {
            spatial::HeapWalkDecoder decoder(photon_count);
            replay::WalkLines lines(layout, 128);
            for (const std::uint32_t q : room().permutation(orderings[o])) {
                all[o].start.push_back(all[o].lines.size());
                const auto touches = lines.touches(decoder.decode(walks.walk(q)).elements);
                all[o].lines.insert(all[o].lines.end(), touches.begin(), touches.end());
                if (all[o].lines.size() > 20'000'000) break;
            }
            all[o].start.push_back(all[o].lines.size());
        }
        return all;
    }();
    return streams[ordering];
}

/// 0: set-associative caches alone; 1: fully associative ones, too; 2: and the classes of misses. 3: likewise
/// for the caches of 16 KB to 4 MB only.
cachesim::FamilyConfig family(std::int64_t extent) {
    cachesim::FamilyConfig config{.levels = {}, .distances = extent > 0, .conflicts = extent > 1};
    if (extent == 3) {
        for (std::uint64_t sets = 8; sets <= 1 << 15; sets *= 2)
            config.levels.push_back(
                {sets, static_cast<std::uint32_t>(std::min<std::uint64_t>(16, (1 << 15) / sets))});
        return config;
    }
    for (std::uint64_t sets = 1; sets <= 1 << 16; sets *= 2) config.levels.push_back({sets, 16});
    return config;
}

std::uint64_t misses_alone(const Stream& of, std::uint64_t sets, std::uint32_t ways) {
    cachesim::LruCache cache({.size_bytes = sets * ways * 128, .line_bytes = 128, .ways = ways});
    for (std::size_t i = 0; i < of.lines.size(); i += 1 << 14)
        cache.access(std::span(of.lines).subspan(i, std::min<std::size_t>(1 << 14, of.lines.size() - i)),
                     trace::Region::photons);
    return cache.total().misses;
}

void report(benchmark::State& state, const cachesim::FamilyCounts& counts) {
    const Stream& of = stream(static_cast<std::size_t>(state.range(0)));
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(of.lines.size()));
    state.SetLabel(orderings[static_cast<std::size_t>(state.range(0))]);
    if (!counts.levels.empty() && counts.accesses == of.lines.size())
        for (const std::uint64_t sets : {16, 1024, 4096})
            if (counts.misses(sets, 8) != misses_alone(of, sets, 8))
                state.SkipWithError("other misses than the cache alone");
}

void one_pass(benchmark::State& state) {
    const Stream& of = stream(static_cast<std::size_t>(state.range(0)));
    cachesim::FamilyCounts counts;
    for (auto unused : state) {
        cachesim::LruFamily caches(family(state.range(1)));
        caches.access(of.lines);
        counts = caches.counts();
    }
    report(state, counts);
}
BENCHMARK(one_pass)
    ->ArgsProduct({{0, 1}, {0, 1, 2, 3}})
    ->ArgNames({"order", "extent"})
    ->Unit(benchmark::kMillisecond);

void stack_distance(benchmark::State& state) {
    const Stream& of = stream(static_cast<std::size_t>(state.range(0)));
    cachesim::FamilyCounts counts;
    for (auto unused : state) {
        cachesim::LruFamily caches({.levels = {}, .distances = true});
        caches.access(of.lines);
        counts = caches.counts();
    }
    report(state, counts);
}
BENCHMARK(stack_distance)->Arg(0)->Arg(1)->ArgName("order")->Unit(benchmark::kMillisecond);

/// The same with first touches alone.
void one_pass_first_touches(benchmark::State& state) {
    const Stream& of = stream(static_cast<std::size_t>(state.range(0)));
    cachesim::FamilyCounts counts;
    for (auto unused : state) {
        const replay::Layout layout = bench::heap_20();
        replay::WalkLines lines(layout, 128);
        cachesim::LruFamily caches(family(state.range(1)));
        for (std::size_t w = 0; w + 1 < of.start.size(); ++w) {
            const auto first =
                lines.first(std::span(of.lines).subspan(of.start[w], of.start[w + 1] - of.start[w]));
            caches.access_first(first.lines, first.last_rank);
        }
        counts = caches.counts();
    }
    report(state, counts);
    state.counters["first"] = static_cast<double>(counts.accesses) / static_cast<double>(of.lines.size());
}
BENCHMARK(one_pass_first_touches)
    ->ArgsProduct({{0, 1}, {0, 1, 2, 3}})
    ->ArgNames({"order", "extent"})
    ->Unit(benchmark::kMillisecond);

void first_touches_only(benchmark::State& state) {
    const Stream& of = stream(static_cast<std::size_t>(state.range(0)));
    std::uint64_t sum = 0;
    for (auto unused : state) {
        const replay::Layout layout = bench::heap_20();
        replay::WalkLines lines(layout, 128);
        for (std::size_t w = 0; w + 1 < of.start.size(); ++w)
            sum += lines.first(std::span(of.lines).subspan(of.start[w], of.start[w + 1] - of.start[w]))
                       .lines.size();
    }
    benchmark::DoNotOptimize(sum);
    report(state, {});
}
BENCHMARK(first_touches_only)->Arg(0)->Arg(1)->ArgName("order")->Unit(benchmark::kMillisecond);

void each_cache_alone(benchmark::State& state) {
    const Stream& of = stream(static_cast<std::size_t>(state.range(0)));
    std::uint64_t sum = 0;
    for (auto unused : state)
        for (std::uint64_t sets = 1; sets <= 1 << 16; sets *= 2)
            for (std::uint32_t ways = 1; ways <= 16; ++ways) sum += misses_alone(of, sets, ways);
    benchmark::DoNotOptimize(sum);
    report(state, {});
}
BENCHMARK(each_cache_alone)->Arg(0)->Arg(1)->ArgName("order")->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
