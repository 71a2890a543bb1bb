// cachesim/lru/recency_rows.h -- the sets of LRU caches as rows of time stamps, newest first. A line is known
// by the stamp of its last touch, so a row holds no tags: the depth of a line in its set is the number of
// stamps in the row above its own, and a row of 16 stamps answers for 1 to 16 ways at once (Mattson et al.
// 1970: LRU is a stack algorithm).
//
// Stamps are unique, from first_stamp up; never_touched and empty_place are below all of them. Compiled for
// several instruction sets and chosen at run time (Highway); all count the same.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace regather::cachesim {

inline constexpr std::int32_t never_touched = 0, empty_place = 1, first_stamp = 2;
inline constexpr std::int32_t last_stamp = 0x7fffffff;

/// One number of sets, up to 2^24. `row` places each (4, 8, 16 or 32), aligned to 64 bytes, newest first.
struct RecencyRows {
    std::int32_t* stamps;
    std::uint32_t row, set_bits;
};

/// Accesses in their order. Parallel arrays of `count` and, of `line`, prefetched_ahead more that hold
/// anything; those that may be null are left out when nobody asks.
inline constexpr std::size_t prefetched_ahead = 16;
struct Touches {
    const std::uint32_t* line;   ///< Low bits of line number x 64; the set is in those from bit 6 on.
    const std::int32_t* before;  ///< Stamp of the line's last touch, or never_touched.
    const std::int32_t*
        now;  ///< Its stamp from here on, above every `before` that is not among these touches.
    const std::int32_t* distance;  ///< Different lines touched since the last touch; last_stamp when there is
                                   ///< none. May be null.
    const std::int32_t* counted;   ///< -1: counted; 0: only moves its line. May be null: all are counted.
    std::size_t count;             ///< At most 2^20.
};

/// What is added to, by place i of a row: a cache of i + 1 ways.
struct RowCounts {
    std::uint64_t* misses;     ///< Touches that a cache of i + 1 ways misses.
    std::uint64_t* conflicts;  ///< Of these, hits of a fully associative cache of the same size. May be null.
};

/// Through each of `rows`, which have places of one number; `counts` is as long, and null alike in all.
void touch_rows(std::span<const RecencyRows> rows, const Touches& touches, std::span<const RowCounts> counts);

}  // namespace regather::cachesim
