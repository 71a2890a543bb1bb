// reorder/sort.h -- sorts query numbers by key. Method: key and index packed into one 64-bit word, so that
// Highway's vqsort (Blacher et al., "Vectorized and performance-portable Quicksort", 2022) decides ties by
// capture order for free; chunks are sorted side by side and merged. Chosen by bench/sort_bench.cpp.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace regather::reorder {

/// 0 .. n-1 by (keys[i], i), the same on any number of threads. Needs 16 bytes a key while it runs, none when
/// the keys are ascending already or are ranks. At most 2^32 - 1 keys.
std::vector<std::uint32_t> sorted_permutation(std::span<const std::uint64_t> keys);

}  // namespace regather::reorder
