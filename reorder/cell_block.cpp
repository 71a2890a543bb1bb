#include "reorder/cell_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reorder/cell_block.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace regather::reorder::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The states of the table in curve.cpp without a table: instead of the state, all lower bits of the
/// coordinates are turned into the frame of the child, level by level, as Skilling does ("Programming the
/// Hilbert curve", 2004) for another of the Hilbert curves. In its frame the octant (a, b, c) is the Gray
/// code of its place. Into the frame of that child lead a reflection at Hamilton's entry corner, and a
/// rotation of the axes by his direction:
///   octant   000 001 011 010 110 111 101 100   (places 0 to 7)
///   entry    000 000 000 011 011 110 110 101
///   rotation   1   2   2   0   0   2   2   1   right
void turn_lanes(CellBlock& block, std::uint32_t bits) {
    const hn::ScalableTag<std::uint32_t> d;
    const hn::RebindToSigned<decltype(d)> di;
    using Lanes = hn::Vec<decltype(d)>;
    const auto all_of_top_bit = [&](Lanes v) {
        return hn::BitCast(d, hn::ShiftRight<31>(hn::BitCast(di, v)));
    };
    const int unused = 32 - static_cast<int>(bits);
    for (std::size_t i = 0; i < CellBlock::cells; i += hn::Lanes(d)) {
        // The curve begins with a rotation by one. The level at hand is the top bit.
        Lanes first = hn::ShiftLeftSame(hn::Load(d, block.z + i), unused);
        Lanes second = hn::ShiftLeftSame(hn::Load(d, block.x + i), unused);
        Lanes third = hn::ShiftLeftSame(hn::Load(d, block.y + i), unused);
        Lanes gray_first = hn::Zero(d), gray_second = gray_first, gray_third = gray_first;
        for (std::uint32_t level = 0; level < bits; ++level) {
            const Lanes a = all_of_top_bit(first), b = all_of_top_bit(second), c = all_of_top_bit(third);
            gray_first = hn::Sub(hn::Add(gray_first, gray_first), a);  // appends the bit: a set one is -1
            gray_second = hn::Sub(hn::Add(gray_second, gray_second), b);
            gray_third = hn::Sub(hn::Add(gray_third, gray_third), c);

            const Lanes only_b = hn::AndNot(c, b);
            first = hn::Xor(first, hn::AndNot(only_b, a));
            second = hn::Xor(second, hn::Or(only_b, hn::And(a, c)));
            third = hn::Xor(third, hn::AndNot(c, hn::Or(a, b)));

            const Lanes by_one = hn::Not(hn::Or(b, c)), by_two = c;
            const Lanes swap_12 = hn::Xor(first, second), swap_13 = hn::Xor(first, third),
                        swap_23 = hn::Xor(second, third);
            first = hn::Xor(first, hn::Or(hn::And(swap_12, by_two), hn::And(swap_13, by_one)));
            second = hn::Xor(second, hn::Or(hn::And(swap_23, by_two), hn::And(swap_12, by_one)));
            third = hn::Xor(third, hn::Or(hn::And(swap_13, by_two), hn::And(swap_23, by_one)));
            first = hn::Add(first, first);
            second = hn::Add(second, second);
            third = hn::Add(third, third);
        }
        const Lanes place_second = hn::Xor(gray_first, gray_second);
        hn::Store(gray_first, d, block.x + i);
        hn::Store(place_second, d, block.y + i);
        hn::Store(hn::Xor(place_second, gray_third), d, block.z + i);
    }
}

}  // namespace regather::reorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace regather::reorder {

HWY_EXPORT(turn_lanes);

void turn_along_hilbert(CellBlock& block, std::uint32_t bits) {
    HWY_DYNAMIC_DISPATCH(turn_lanes)(block, bits);
}

}  // namespace regather::reorder
#endif
