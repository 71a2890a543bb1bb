// bench/sort_bench.cpp -- ways to sort queries by key with ties in capture order, at the size of the paper's
// image. Every one checks its answer. Keys: Hilbert codes of 63 bits over the walls of a room, whole image
// (ties and near ties as in a capture), 16 bits an axis in tiles of 16 x 16, and 10 bits an axis, whole
// image.
#include <benchmark/benchmark.h>
#include <hwy/contrib/sort/vqsort.h>
#include <immintrin.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <vector>

#include "reorder/catalogue.h"
#include "reorder/sort.h"

namespace {

using namespace regather;

constexpr std::uint32_t image = 512, samples = 100;
constexpr std::size_t count = std::size_t{image} * image * samples;

std::uint64_t scrambled(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
    x = (x ^ x >> 27) * 0x94d049bb133111eb;
    return x ^ x >> 31;
}

float unit(std::uint64_t x) {
    return static_cast<float>(scrambled(x) >> 40) * 0x1p-24f;
}

struct Walls {
    std::vector<trace::Vec3> position;
    std::vector<std::uint32_t> pixel;
    reorder::Workload work;
    Walls() : position(count), pixel(count) {
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint64_t wall = scrambled(i) % 6;
            position[i] = {6 * unit(3 * i), 5 * unit(3 * i + 1), 3 * unit(3 * i + 2)};
            position[i][static_cast<int>(wall / 2)] = wall % 2 ? 3.0f : 0.0f;
            pixel[i] = static_cast<std::uint32_t>(i / samples);
        }
        work = {.position = position,
                .direction = {},
                .pixel = pixel,
                .leaf_kd = {},
                .leaf_bvh = {},
                .bounds = trace::bounds_of(position),
                .image_width = image,
                .image_height = image};
    }
};

const Walls& walls() {
    static const Walls queries;
    return queries;
}

constexpr std::array<const char*, 3> key_orderings{"hilbert", "hilbert:tile=16", "hilbert:bits=10"};

const std::vector<std::uint64_t>& keys_of(std::int64_t kind_asked_for) {
    static const std::array<std::vector<std::uint64_t>, key_orderings.size()> keys = [] {
        std::array<std::vector<std::uint64_t>, key_orderings.size()> made;
        for (std::size_t kind = 0; kind < key_orderings.size(); ++kind) {
            made[kind].resize(count);
            reorder::make_ordering(key_orderings[kind])
                ->assign_keys(walls().work, reorder::default_onchip_bytes, made[kind]);
        }
        return made;
    }();
    return keys[static_cast<std::size_t>(kind_asked_for)];
}

bool in_order(const std::vector<std::uint64_t>& keys, const std::vector<std::uint32_t>& order) {
    if (order.size() != keys.size()) return false;
    for (std::size_t r = 1; r < order.size(); ++r) {
        const std::uint32_t a = order[r - 1], b = order[r];
        if (keys[a] > keys[b] || (keys[a] == keys[b] && a >= b)) return false;
    }
    return true;  // strictly ascending pairs (key, index) as many as there are queries: a permutation
}

struct Pair {
    std::uint64_t key, index;
    bool operator<(const Pair& o) const { return key != o.key ? key < o.key : index < o.index; }
};

template <class Sort>
std::vector<std::uint32_t> by_pairs(const std::vector<std::uint64_t>& keys, Sort&& sort) {
    const auto pairs = std::make_unique_for_overwrite<Pair[]>(keys.size());
    tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) { pairs[i] = {keys[i], i}; });
    sort(pairs.get(), pairs.get() + keys.size());
    std::vector<std::uint32_t> order(keys.size());
    for (std::size_t r = 0; r < order.size(); ++r) order[r] = static_cast<std::uint32_t>(pairs[r].index);
    return order;
}

std::vector<std::uint32_t> std_sort(const std::vector<std::uint64_t>& keys) {
    return by_pairs(keys, [](Pair* begin, Pair* end) { std::sort(begin, end); });
}

std::vector<std::uint32_t> tbb_sort(const std::vector<std::uint64_t>& keys) {
    return by_pairs(keys, [](Pair* begin, Pair* end) { tbb::parallel_sort(begin, end); });
}

std::vector<std::uint32_t> vqsort_128(const std::vector<std::uint64_t>& keys) {
    const auto pairs = std::make_unique_for_overwrite<hwy::uint128_t[]>(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) pairs[i] = {.lo = i, .hi = keys[i]};
    hwy::Sorter()(pairs.get(), keys.size(), hwy::SortAscending());
    std::vector<std::uint32_t> order(keys.size());
    for (std::size_t r = 0; r < order.size(); ++r) order[r] = static_cast<std::uint32_t>(pairs[r].lo);
    return order;
}

/// Least significant digit first, 8 bits; 12 bytes a record in two buffers; digits that never differ are
/// skipped.
std::vector<std::uint32_t> radix(const std::vector<std::uint64_t>& keys) {
    const std::size_t n = keys.size();
    std::vector<std::array<std::uint32_t, 256>> digits(8);
    for (const std::uint64_t key : keys)
        for (std::size_t d = 0; d < 8; ++d) ++digits[d][key >> 8 * d & 255];
    std::vector<std::uint64_t> key(keys), next_key(n);
    std::vector<std::uint32_t> index(n), next_index(n);
    for (std::size_t i = 0; i < n; ++i) index[i] = static_cast<std::uint32_t>(i);
    for (std::size_t d = 0; d < 8; ++d) {
        if (std::find(digits[d].begin(), digits[d].end(), n) != digits[d].end()) continue;
        std::uint32_t start = 0;
        for (std::uint32_t& digit : digits[d]) start += std::exchange(digit, start);
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t to = digits[d][key[i] >> 8 * d & 255]++;
            next_key[to] = key[i];
            next_index[to] = index[i];
        }
        key.swap(next_key);
        index.swap(next_index);
    }
    return index;
}

/// Key and index in one word where both fit, empty otherwise; least significant digit first, 8 bits of the
/// key only. A line of each digit is collected and then written past the caches.
std::vector<std::uint32_t> radix_write_combining(const std::vector<std::uint64_t>& keys) {
    const std::size_t n = keys.size();
    const int index_bits = static_cast<int>(std::bit_width(n - 1));
    const int key_bits = static_cast<int>(std::bit_width(*std::max_element(keys.begin(), keys.end())));
    if (key_bits + index_bits > 64) return {};
    constexpr std::size_t line = 8;
    struct alignas(64) Line {
        std::uint64_t words[line];
    };
    const auto lines = n / line + 1;
    auto from = std::make_unique_for_overwrite<Line[]>(lines),
         to = std::make_unique_for_overwrite<Line[]>(lines);
    const std::size_t passes = static_cast<std::size_t>(key_bits + 7) / 8;
    std::vector<std::array<std::uint32_t, 256>> digits(passes);
    std::uint64_t* words = from[0].words;
    for (std::size_t i = 0; i < n; ++i) {
        words[i] = keys[i] << index_bits | i;
        for (std::size_t d = 0; d < passes; ++d) ++digits[d][keys[i] >> 8 * d & 255];
    }
    std::vector<Line> collected(256);
    for (std::size_t d = 0; d < passes; ++d) {
        std::array<std::uint32_t, 256> next, first;
        std::uint32_t start = 0;
        for (std::size_t digit = 0; digit < 256; ++digit) {
            next[digit] = first[digit] = start;
            start += digits[d][digit];
        }
        std::uint64_t* const source = from[0].words;
        std::uint64_t* const target = to[0].words;
        const int shift = index_bits + 8 * static_cast<int>(d);
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t digit = source[i] >> shift & 255;
            const std::uint32_t place = next[digit]++;
            collected[digit].words[place % line] = source[i];
            if (place % line != line - 1) continue;
            const std::size_t begin = place - (line - 1);
            if (begin >= first[digit]) {
                for (std::size_t w = 0; w < line; w += 2)
                    _mm_stream_si128(
                        reinterpret_cast<__m128i*>(target + begin + w),
                        _mm_load_si128(reinterpret_cast<const __m128i*>(collected[digit].words + w)));
            } else {  // the line begins with another digit's words
                for (std::size_t w = first[digit]; w <= place; ++w)
                    target[w] = collected[digit].words[w % line];
            }
        }
        _mm_sfence();
        for (std::size_t digit = 0; digit < 256; ++digit)
            for (std::size_t w = std::max<std::size_t>(first[digit], next[digit] / line * line);
                 w < next[digit]; ++w)
                target[w] = collected[digit].words[w % line];
        from.swap(to);
    }
    std::vector<std::uint32_t> order(n);
    words = from[0].words;
    for (std::size_t r = 0; r < n; ++r)
        order[r] = static_cast<std::uint32_t>(words[r] & ((std::uint64_t{1} << index_bits) - 1));
    return order;
}

std::vector<std::uint32_t> ours(const std::vector<std::uint64_t>& keys) {
    return reorder::sorted_permutation(keys);
}

template <std::vector<std::uint32_t> (*sort)(const std::vector<std::uint64_t>&)>
void Sort(benchmark::State& state) {
    const std::vector<std::uint64_t>& keys = keys_of(state.range(0));
    std::vector<std::uint32_t> order;
    for (auto _ : state) order = sort(keys);
    if (order.empty()) {
        state.SkipWithError("key and index do not fit 64 bits");
        return;
    }
    if (!in_order(keys, order)) state.SkipWithError("wrong order");
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(keys.size()));
}

void Keys(benchmark::State& state, const char* spec) {
    const auto ordering = reorder::make_ordering(spec);
    std::vector<std::uint64_t> keys(count);
    for (auto _ : state) ordering->assign_keys(walls().work, reorder::default_onchip_bytes, keys);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}

void Order(benchmark::State& state, const char* spec) {
    const auto ordering = reorder::make_ordering(spec);
    std::vector<std::uint64_t> keys(count);
    ordering->assign_keys(walls().work, reorder::default_onchip_bytes, keys);
    reorder::Ordered result;
    for (auto _ : state) result = reorder::order(*ordering, walls().work);
    if (!in_order(keys, result.permutation)) state.SkipWithError("wrong order");
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}

#define SORT(function)        \
    BENCHMARK(Sort<function>) \
        ->Name(#function)     \
        ->ArgName("keys")     \
        ->Arg(0)              \
        ->Arg(1)              \
        ->Arg(2)              \
        ->UseRealTime()       \
        ->Unit(benchmark::kMillisecond)
SORT(std_sort);
SORT(tbb_sort);
SORT(vqsort_128);
SORT(radix);
SORT(radix_write_combining);
SORT(ours);
#define KEYS(spec) BENCHMARK_CAPTURE(Keys, spec, spec)->UseRealTime()->Unit(benchmark::kMillisecond)
KEYS("hilbert");
KEYS("hilbert:tile=16");
KEYS("hilbert:bits=10");
KEYS("morton");
#define ORDER(spec) BENCHMARK_CAPTURE(Order, spec, spec)->UseRealTime()->Unit(benchmark::kMillisecond)
ORDER("naive");
ORDER("random");
ORDER("tiled");
ORDER("hilbert");
ORDER("hilbert:tile=16");
ORDER("hilbert:bits=10");
ORDER("morton");
ORDER("swizzle");
ORDER("hashed");

}  // namespace

BENCHMARK_MAIN();
