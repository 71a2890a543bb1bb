// cachesim/lru/set_kernel.h -- LRU sets as rows of tags, most recently used first: an access compares a whole
// row with one tag and moves the tag that it found (or the last one, replaced) to the front, without a
// branch. Compiled for several instruction sets and chosen at run time (Highway); all count the same.
//
// A tag is line >> set_bits in the low bits and the line's state (engine.h) in the top state_bits. Rows have
// 4, 8, 16 or 32 tags; those past the ways, and ways that hold nothing, are `empty`.
#pragma once
#include <cstdint>

#include "cachesim/lru/engine.h"

namespace regather::cachesim {

inline constexpr unsigned state_bits = 4;
static_assert(trace::region_count < 1u << state_bits);

/// T: std::uint32_t or std::uint64_t.
template <class T>
struct TagFormat {
    static constexpr unsigned shift = 8 * sizeof(T) - state_bits;
    static constexpr T empty = static_cast<T>(~T{0}) >> state_bits;  ///< No tag of a line is this or more.
};

/// The rows of a cache; aligned to 64 bytes.
struct SetRows {
    void* tags;
    bool wide;  ///< std::uint64_t, else std::uint32_t.
    std::uint32_t row, ways, set_bits;
};

struct SetCounts {
    std::size_t done = 0;  ///< Lines accessed; fewer than asked for when the next tag does not fit.
    std::uint64_t misses = 0;
    std::uint64_t writebacks[1u << state_bits] = {};  ///< By state of the line evicted.
};

/// Accesses the lines of `run` from `begin` on. With `stateless` all are reads and no line held is dirty.
SetCounts access_sets(const SetRows& rows, const Run& run, std::size_t begin, bool stateless);

}  // namespace regather::cachesim
