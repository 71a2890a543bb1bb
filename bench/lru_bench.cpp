// bench/lru_bench.cpp -- line accesses a second of one LRU cache of 128 KB and 128 B lines, on a trace that
// mostly misses. The baseline is what a textbook writes: an array of structs with the time of last use.
// Before timing, each checks that it counts the baseline's misses.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <vector>

#include "cachesim/cache.h"
#include "cachesim/distinct.h"

namespace {

using namespace regather;
using cachesim::Line;

constexpr std::size_t trace_lines = 20'000'000;

struct TextbookLru {
    struct Way {
        std::uint64_t line = 0, used = 0;
        bool valid = false;
    };
    std::uint64_t set_mask;
    std::uint32_t ways;
    std::vector<Way> slots;
    std::uint64_t clock = 0, misses = 0;

    TextbookLru(std::uint64_t sets, std::uint32_t w) : set_mask(sets - 1), ways(w), slots(sets * w) {}

    void access(std::uint64_t line) {
        Way* const set = &slots[(line & set_mask) * ways];
        Way* victim = set;
        for (Way* way = set; way != set + ways; ++way) {
            if (way->valid && way->line == line) {
                way->used = ++clock;
                return;
            }
            if (way->used < victim->used) victim = way;
        }
        ++misses;
        *victim = {line, ++clock, true};
    }
};

/// Searches of a left-balanced tree of 2^20 records of 20 bytes, depth first, each into a random corner: the
/// far child is entered now and then near the root and mostly near the leaves, as kNN searches in random
/// order do.
const std::vector<Line>& tree_searches() {
    static const std::vector<Line> lines = [] {
        constexpr std::uint64_t nodes = (1u << 20) - 1;
        std::vector<Line> visited;
        std::vector<std::uint64_t> open;
        std::uint64_t random = 1;
        while (visited.size() < trace_lines) {
            if (open.empty()) open.push_back(0);
            const std::uint64_t node = open.back();
            open.pop_back();
            visited.push_back(Line{node * 20 / 128});
            if (2 * node + 2 >= nodes) continue;
            random = random * 6364136223846793005 + 1442695040888963407;
            const std::uint64_t far = 1 + (random >> 63);
            const bool enter_far = (random >> 32) % 16 < (node < 1u << 12 ? 2 : 11);
            if (enter_far) open.push_back(2 * node + far);
            open.push_back(2 * node + 3 - far);
        }
        return visited;
    }();
    return lines;
}

std::uint64_t textbook_misses(std::uint32_t ways) {
    TextbookLru cache(1024 / ways, ways);
    for (const Line line : tree_searches()) cache.access(static_cast<std::uint64_t>(line));
    return cache.misses;
}

void report(benchmark::State& state, std::uint64_t misses) {
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * trace_lines));
    state.counters["misses"] = static_cast<double>(misses);
}

void textbook(benchmark::State& state) {
    const auto ways = static_cast<std::uint32_t>(state.range(0));
    std::uint64_t misses = 0;
    tree_searches();
    for (auto _ : state) misses = textbook_misses(ways);
    report(state, misses);
}

/// Lines are handed over in batches of `batch`, as replay does; `offset` is added to each line number.
void simulate(benchmark::State& state, std::uint32_t ways, std::uint64_t offset, cachesim::Access kind) {
    static std::vector<std::uint64_t> expected(1025);
    std::uint64_t& misses_expected = expected[ways == cachesim::fully_associative ? 1024 : ways];
    if (misses_expected == 0 && ways != cachesim::fully_associative) misses_expected = textbook_misses(ways);
    std::vector<Line> lines = tree_searches();
    for (Line& line : lines) line = Line{static_cast<std::uint64_t>(line) + offset};
    constexpr std::size_t batch = 1 << 14;

    std::uint64_t misses = 0;
    for (auto _ : state) {
        cachesim::LruCache cache({128 * 1024, 128, ways});
        for (std::size_t i = 0; i < lines.size(); i += batch)
            cache.access(std::span(lines).subspan(i, std::min(batch, lines.size() - i)),
                         trace::Region::photons, kind);
        misses = cache.total().misses;
    }
    // A full set of 1024 ways takes the textbook a minute: the first 200,000 accesses are compared.
    if (ways == cachesim::fully_associative) {
        TextbookLru slow(1, 1024);
        cachesim::LruCache cache({128 * 1024, 128, ways});
        const auto head = std::span(lines).first(200'000);
        for (const Line line : head) slow.access(static_cast<std::uint64_t>(line));
        cache.access(head, trace::Region::photons);
        if (cache.total().misses != slow.misses) state.SkipWithError("misses differ from the textbook's");
    } else if (misses != misses_expected) {
        state.SkipWithError(
            fmt::format("found {} misses, the textbook has {}", misses, misses_expected).c_str());
    }
    report(state, misses);
}

void lru(benchmark::State& state) {
    simulate(state, static_cast<std::uint32_t>(state.range(0)), 0, cachesim::Access::read);
}
/// Line numbers from 2^50 on: 64-bit tags.
void lru_wide(benchmark::State& state) {
    simulate(state, static_cast<std::uint32_t>(state.range(0)), std::uint64_t{1} << 50,
             cachesim::Access::read);
}
void lru_writes(benchmark::State& state) {
    simulate(state, static_cast<std::uint32_t>(state.range(0)), 0, cachesim::Access::write);
}

void distinct_lines(benchmark::State& state) {
    const auto& lines = tree_searches();
    std::uint64_t count = 0;
    for (auto _ : state) {
        cachesim::DistinctLines distinct;
        distinct.add(lines);
        count = distinct.count();
    }
    report(state, count);
}

BENCHMARK(textbook)->Arg(4)->Arg(8)->Arg(16)->ArgName("ways")->Unit(benchmark::kMillisecond);
BENCHMARK(lru)->Arg(1)->Arg(2)->Arg(4)->Arg(8)->Arg(16)->Arg(32)->Arg(64)->Arg(0)->ArgName("ways")->Unit(
    benchmark::kMillisecond);
BENCHMARK(lru_wide)->Arg(4)->Arg(8)->Arg(16)->Arg(32)->ArgName("ways")->Unit(benchmark::kMillisecond);
BENCHMARK(lru_writes)->Arg(4)->Arg(8)->Arg(16)->Arg(0)->ArgName("ways")->Unit(benchmark::kMillisecond);
BENCHMARK(distinct_lines)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
