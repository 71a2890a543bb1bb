#include "reorder/sort.h"

#include <hwy/contrib/sort/vqsort.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <numeric>

namespace regather::reorder {
namespace {

constexpr std::size_t smallest_chunk = 1 << 15;  ///< Below this a task costs more than it saves.
constexpr std::size_t merge_piece = 1 << 17;
constexpr std::size_t vector_sort_from = 128;  ///< Shorter runs: std::sort.
constexpr std::uint32_t no_index = 0xffffffff;

using Words = std::unique_ptr<std::uint64_t[]>;
using Range = tbb::blocked_range<std::size_t>;

struct Shape {
    std::uint64_t min = ~std::uint64_t{0}, max = 0;
    bool ascending = true;
};

Shape shape_of(std::span<const std::uint64_t> keys) {
    const auto scan = [&](const Range& range, Shape shape) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            shape.min = std::min(shape.min, keys[i]);
            shape.max = std::max(shape.max, keys[i]);
            shape.ascending &= i == 0 || keys[i - 1] <= keys[i];
        }
        return shape;
    };
    const auto join = [](const Shape& a, const Shape& b) {
        return Shape{std::min(a.min, b.min), std::max(a.max, b.max), a.ascending && b.ascending};
    };
    return tbb::parallel_reduce(Range(0, keys.size(), smallest_chunk), Shape{}, scan, join);
}

/// True when the keys are a permutation of 0 .. n-1, which is then inverted into `order`.
bool invert_ranks(std::span<const std::uint64_t> keys, std::span<std::uint32_t> order) {
    std::fill(order.begin(), order.end(), no_index);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (order[keys[i]] != no_index) return false;
        order[keys[i]] = static_cast<std::uint32_t>(i);
    }
    return true;
}

void sort_words(std::uint64_t* words, std::size_t count) {
    if (count < vector_sort_from)
        std::sort(words, words + count);
    else
        hwy::Sorter()(words, count, hwy::SortAscending());
}

/// How many of the `rank` smallest words of two sorted runs without common words come from `a`.
std::size_t taken_from_first(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b,
                             std::size_t rank) {
    std::size_t low = rank > b.size() ? rank - b.size() : 0, high = std::min(rank, a.size());
    while (low < high) {
        const std::size_t middle = low + (high - low) / 2;
        if (a[middle] < b[rank - middle - 1])
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

void merge_runs(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b, std::uint64_t* out) {
    const std::size_t total = a.size() + b.size(), pieces = (total + merge_piece - 1) / merge_piece;
    tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) {
        const std::size_t begin = piece * merge_piece, end = std::min(total, begin + merge_piece);
        const std::size_t a_begin = taken_from_first(a, b, begin), a_end = taken_from_first(a, b, end);
        std::merge(a.begin() + a_begin, a.begin() + a_end, b.begin() + (begin - a_begin),
                   b.begin() + (end - a_end), out + begin);
    });
}

/// Sorts `words`, which all differ; `spare` is as long. The result is in `words`.
void sort_in_chunks(Words& words, Words& spare, std::size_t count) {
    const auto threads = static_cast<std::size_t>(std::max(1, tbb::this_task_arena::max_concurrency()));
    const std::size_t chunks = std::bit_floor(std::clamp<std::size_t>(count / smallest_chunk, 1, threads));
    const auto start = [&](std::size_t chunk) { return count * chunk / chunks; };
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        sort_words(words.get() + start(chunk), start(chunk + 1) - start(chunk));
    });
    for (std::size_t width = 1; width < chunks; width *= 2) {
        tbb::parallel_for(std::size_t{0}, chunks / (2 * width), [&](std::size_t pair) {
            const std::size_t begin = start(pair * 2 * width), middle = start(pair * 2 * width + width),
                              end = start(pair * 2 * width + 2 * width);
            merge_runs({words.get() + begin, words.get() + middle}, {words.get() + middle, words.get() + end},
                       spare.get() + begin);
        });
        std::swap(words, spare);
    }
}

}  // namespace

std::vector<std::uint32_t> sorted_permutation(std::span<const std::uint64_t> keys) {
    const std::size_t count = keys.size();
    std::vector<std::uint32_t> order(count);
    const Shape shape = shape_of(keys);
    if (shape.ascending) {
        std::iota(order.begin(), order.end(), 0u);
        return order;
    }
    if (shape.max < count && invert_ranks(keys, order)) return order;

    // A word is as much of the key's top as fits above the index. What is cut off is at most 32 bits, so keys
    // that agree in the rest are ordered by one more sort of (the cut-off bits, index).
    const int index_bits = static_cast<int>(std::bit_width(count - 1));
    const int key_bits = static_cast<int>(std::bit_width(shape.max - shape.min));
    const int cut = std::max(0, key_bits + index_bits - 64);
    const std::uint64_t index_mask = (std::uint64_t{1} << index_bits) - 1,
                        cut_mask = (std::uint64_t{1} << cut) - 1;
    Words words = std::make_unique_for_overwrite<std::uint64_t[]>(count);
    Words spare = std::make_unique_for_overwrite<std::uint64_t[]>(count);
    tbb::parallel_for(Range(0, count, smallest_chunk), [&](const Range& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i)
            words[i] = ((keys[i] - shape.min) >> cut) << index_bits | i;
    });
    sort_in_chunks(words, spare, count);

    const auto same_top = [&](std::size_t i, std::size_t j) { return (words[i] ^ words[j]) <= index_mask; };
    tbb::parallel_for(Range(0, count, smallest_chunk), [&](const Range& range) {
        std::size_t i = range.begin();
        if (cut != 0)  // a run of equal tops belongs to the range that it begins in
            while (i != range.end() && i != 0 && same_top(i - 1, i)) ++i;
        while (i < range.end()) {
            std::size_t end = i + 1;
            order[i] = static_cast<std::uint32_t>(words[i] & index_mask);
            if (cut != 0)
                while (end != count && same_top(i, end)) ++end;
            if (end - i > 1) {
                for (std::size_t j = i; j != end; ++j) {
                    const std::uint64_t index = words[j] & index_mask;
                    spare[j] = ((keys[index] - shape.min) & cut_mask) << index_bits | index;
                }
                sort_words(spare.get() + i, end - i);
                for (std::size_t j = i; j != end; ++j)
                    order[j] = static_cast<std::uint32_t>(spare[j] & index_mask);
            }
            i = end;
        }
    });
    return order;
}

}  // namespace regather::reorder
