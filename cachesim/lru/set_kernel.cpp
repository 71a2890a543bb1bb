#include "cachesim/lru/set_kernel.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cachesim/lru/set_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace regather::cachesim::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A row moves by one place towards its end in any case; the compare only selects which places take the moved
/// tag: those up to the one found, or all. So the work on one set waits for little of the last access to the
/// same set.
template <class T, std::size_t row, bool stateless>
SetCounts access_rows(const SetRows& rows, const Run& run, std::size_t begin) {
    const hn::CappedTag<T, row> d;
    constexpr std::size_t lanes = hn::MaxLanes(d), registers = row / lanes;
    using Tags = hn::Vec<decltype(d)>;
    using Format = TagFormat<T>;

    T* const tags = static_cast<T*>(rows.tags);
    const std::uint64_t set_mask = (std::uint64_t{1} << rows.set_bits) - 1;
    const std::uint64_t all_ways = (std::uint64_t{1} << rows.ways) - 1, last_way = all_ways ^ all_ways >> 1;
    const Tags tag_mask = hn::Set(d, Format::empty);
    const T dirty = static_cast<T>(T{dirty_by(run.region)} << Format::shift);

    HWY_ALIGN T previous[lanes];
    for (std::size_t lane = 0; lane < lanes; ++lane)
        previous[lane] = static_cast<T>((lane + lanes - 1) % lanes);
    const auto rotated = hn::SetTableIndices(d, previous);
    const auto first_lane = hn::FirstN(d, 1);

    SetCounts counts;
    std::uint64_t misses = 0;
    std::size_t i = begin;
    for (; i < run.lines.size(); ++i) {
        const std::uint64_t line = static_cast<std::uint64_t>(run.lines[i]);
        const std::uint64_t wide_tag = line >> rows.set_bits;
        if (HWY_UNLIKELY(wide_tag >= Format::empty)) break;
        const T tag = static_cast<T>(wide_tag);
        T* const set = tags + (line & set_mask) * row;
        const Tags wanted = hn::Set(d, tag);
        Tags held[registers];
        std::uint64_t found = 0;  // the bit of a way
        for (std::size_t r = 0; r < registers; ++r) {
            held[r] = hn::Load(d, set + r * lanes);
            const auto equal = hn::Eq(stateless ? held[r] : hn::And(held[r], tag_mask), wanted);
            std::uint8_t bits[8];  // Highway may write them all
            hn::StoreMaskBits(d, equal, bits);
            found |= std::uint64_t{lanes <= 8 ? bits[0] : bits[0] | unsigned{bits[1]} << 8} << (r * lanes);
        }
        misses += found == 0;
        const std::uint64_t moving = (found ^ (found - 1)) & all_ways;

        Tags carried = wanted;
        if constexpr (!stateless) {
            const T old = set[std::countr_zero(found | last_way)];
            counts.writebacks[found ? clean : old >> Format::shift] += 1;
            carried = hn::Set(d, run.kind(i) == Access::write ? tag | dirty : found ? old : tag);
        }
        for (std::size_t r = 0; r < registers; ++r) {
            const Tags turned = hn::TableLookupLanes(held[r], rotated);
            const Tags moved = hn::IfThenElse(first_lane, carried, turned);
            carried = turned;
            const std::uint64_t bits = moving >> (r * lanes);
            const auto take = hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&bits));
            hn::Store(hn::IfThenElse(take, moved, held[r]), d, set + r * lanes);
        }
    }
    counts.done = i - begin;
    counts.misses = misses;
    return counts;
}

template <class T, std::size_t row>
SetCounts access_by_state(const SetRows& rows, const Run& run, std::size_t begin, bool stateless) {
    return stateless ? access_rows<T, row, true>(rows, run, begin)
                     : access_rows<T, row, false>(rows, run, begin);
}

template <class T>
SetCounts access_by_row(const SetRows& rows, const Run& run, std::size_t begin, bool stateless) {
    switch (rows.row) {
        case 4:
            return access_by_state<T, 4>(rows, run, begin, stateless);
        case 8:
            return access_by_state<T, 8>(rows, run, begin, stateless);
        case 16:
            return access_by_state<T, 16>(rows, run, begin, stateless);
        default:
            return access_by_state<T, 32>(rows, run, begin, stateless);
    }
}

SetCounts access_any(const SetRows& rows, const Run& run, std::size_t begin, bool stateless) {
    return rows.wide ? access_by_row<std::uint64_t>(rows, run, begin, stateless)
                     : access_by_row<std::uint32_t>(rows, run, begin, stateless);
}

}  // namespace regather::cachesim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace regather::cachesim {

HWY_EXPORT(access_any);

SetCounts access_sets(const SetRows& rows, const Run& run, std::size_t begin, bool stateless) {
    return HWY_DYNAMIC_DISPATCH(access_any)(rows, run, begin, stateless);
}

}  // namespace regather::cachesim
#endif
