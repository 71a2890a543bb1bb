#include "cachesim/lru/recency_rows.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cachesim/lru/recency_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace regather::cachesim::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// With r the row, s the same row one place further back and n the new stamp: max(r, min(s, n)) is r with n
/// put into its place. Stamps that are not above the line's last one stay where they are: their place in s is
/// made 0 before. So the line's last stamp is what drops out, or the oldest when it is not there; no place is
/// searched, nothing branches.
///
/// Several numbers of sets side by side: one waits for its last access to the same set while the others go
/// on.
template <std::size_t row, std::size_t levels, bool with_conflicts, bool with_counted>
void touch_levels(const RecencyRows* rows, const Touches& touches, const RowCounts* counts) {
    const hn::CappedTag<std::int32_t, row> d;
    constexpr std::size_t lanes = hn::MaxLanes(d), registers = row / lanes;
    using Stamps = hn::Vec<decltype(d)>;

    HWY_ALIGN std::int32_t previous[lanes];
    HWY_ALIGN std::int32_t top[lanes];
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        previous[lane] = static_cast<std::int32_t>((lane + lanes - 1) % lanes);
        top[lane] = lane == 0 ? last_stamp : 0;
    }
    const auto rotated = hn::SetTableIndices(d, previous);
    const Stamps newest_of_all = hn::Load(d, top);
    const auto first_lane = hn::FirstN(d, 1);
    const Stamps one = hn::Set(d, 1);

    char* stamps[levels];
    std::uint32_t set_mask[levels];
    int set_bits[levels];
    Stamps misses[levels][registers], conflicts[levels][registers];
    for (std::size_t l = 0; l < levels; ++l) {
        stamps[l] = reinterpret_cast<char*>(rows[l].stamps);
        set_mask[l] = ((std::uint32_t{1} << rows[l].set_bits) - 1) << 6;
        set_bits[l] = static_cast<int>(rows[l].set_bits);
        for (std::size_t r = 0; r < registers; ++r) misses[l][r] = conflicts[l][r] = hn::Zero(d);
    }
    const auto set_at = [&](std::size_t l, std::uint32_t line) {  // 64 bytes are a row of 16
        const std::size_t at = line & set_mask[l];
        return reinterpret_cast<std::int32_t*>(
            stamps[l] + (row <= 16 ? at / (16 / std::min<std::size_t>(row, 16)) : at * (row / 16)));
    };
    const std::uint32_t* const line = touches.line;
    const std::int32_t* const befores = touches.before;
    const std::int32_t* const nows = touches.now;
    const std::int32_t* const distances = touches.distance;
    const std::int32_t* const counted = touches.counted;
    const std::size_t count = touches.count;

    for (std::size_t i = 0; i < count; ++i) {
        const Stamps before = hn::Set(d, befores[i]), now = hn::Set(d, nows[i]);
        Stamps step = one;
        if constexpr (with_counted) step = hn::And(one, hn::Set(d, counted[i]));
        for (std::size_t l = 0; l < levels; ++l) {
            __builtin_prefetch(set_at(l, line[i + prefetched_ahead]));
            std::int32_t* const set = set_at(l, line[i]);
            Stamps carried = newest_of_all;
            for (std::size_t r = 0; r < registers; ++r) {
                const Stamps held = hn::Load(d, set + r * lanes);
                const auto above = hn::Gt(held, before);
                const Stamps turned = hn::TableLookupLanes(hn::IfThenElseZero(above, held), rotated);
                const Stamps moved =
                    r == 0 ? hn::Or(turned, newest_of_all) : hn::IfThenElse(first_lane, carried, turned);
                carried = turned;
                hn::Store(hn::Max(held, hn::Min(moved, now)), d, set + r * lanes);
                misses[l][r] = hn::Add(misses[l][r], hn::IfThenElseZero(above, step));
                if constexpr (with_conflicts) {
                    const Stamps full_depth = hn::Set(d, distances[i] >> set_bits[l]);
                    const Stamps place = hn::Iota(d, static_cast<std::int32_t>(r * lanes));
                    const auto conflict = hn::AndNot(hn::Gt(full_depth, place), above);
                    conflicts[l][r] = hn::Add(conflicts[l][r], hn::IfThenElseZero(conflict, step));
                }
            }
        }
    }

    HWY_ALIGN std::int32_t sums[lanes];
    for (std::size_t l = 0; l < levels; ++l)
        for (std::size_t r = 0; r < registers; ++r) {
            hn::Store(misses[l][r], d, sums);
            for (std::size_t lane = 0; lane < lanes; ++lane)
                counts[l].misses[r * lanes + lane] += static_cast<std::uint64_t>(sums[lane]);
            if constexpr (with_conflicts) {
                hn::Store(conflicts[l][r], d, sums);
                for (std::size_t lane = 0; lane < lanes; ++lane)
                    counts[l].conflicts[r * lanes + lane] += static_cast<std::uint64_t>(sums[lane]);
            }
        }
}

template <std::size_t row, bool with_conflicts, bool with_counted>
void touch_rows_of(std::span<const RecencyRows> rows, const Touches& touches,
                   std::span<const RowCounts> counts) {
    constexpr std::size_t registers = row / hn::MaxLanes(hn::CappedTag<std::int32_t, row>());
    constexpr std::size_t most =
        HWY_TARGET <= HWY_AVX3 && registers == 1 ? 4 : 2;  // levels, as registers allow
    // Far ones together: with few sets an access waits for the last one.
    const std::size_t groups = (rows.size() + most - 1) / most;
    for (std::size_t g = 0; g < groups; ++g) {
        RecencyRows some[most];
        RowCounts some_counts[most];
        std::size_t taken = 0;
        for (std::size_t l = g; l < rows.size(); l += groups) {
            some[taken] = rows[l];
            some_counts[taken++] = counts[l];
        }
        if (taken == 1) touch_levels<row, 1, with_conflicts, with_counted>(some, touches, some_counts);
        if (taken == 2) touch_levels<row, 2, with_conflicts, with_counted>(some, touches, some_counts);
        if constexpr (most > 2) {
            if (taken == 3) touch_levels<row, 3, with_conflicts, with_counted>(some, touches, some_counts);
            if (taken == 4) touch_levels<row, 4, with_conflicts, with_counted>(some, touches, some_counts);
        }
    }
}

template <std::size_t row>
void touch_rows_by(std::span<const RecencyRows> rows, const Touches& touches,
                   std::span<const RowCounts> counts) {
    const bool conflicts = counts.front().conflicts != nullptr, counted = touches.counted != nullptr;
    if (conflicts)
        counted ? touch_rows_of<row, true, true>(rows, touches, counts)
                : touch_rows_of<row, true, false>(rows, touches, counts);
    else
        counted ? touch_rows_of<row, false, true>(rows, touches, counts)
                : touch_rows_of<row, false, false>(rows, touches, counts);
}

void touch_rows_any(std::span<const RecencyRows> rows, const Touches& touches,
                    std::span<const RowCounts> counts) {
    switch (rows.front().row) {
        case 4:
            return touch_rows_by<4>(rows, touches, counts);
        case 8:
            return touch_rows_by<8>(rows, touches, counts);
        case 16:
            return touch_rows_by<16>(rows, touches, counts);
        default:
            return touch_rows_by<32>(rows, touches, counts);
    }
}

}  // namespace regather::cachesim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace regather::cachesim {

HWY_EXPORT(touch_rows_any);

void touch_rows(std::span<const RecencyRows> rows, const Touches& touches,
                std::span<const RowCounts> counts) {
    if (rows.empty() || touches.count == 0) return;
    HWY_DYNAMIC_DISPATCH(touch_rows_any)(rows, touches, counts);
}

}  // namespace regather::cachesim
#endif
