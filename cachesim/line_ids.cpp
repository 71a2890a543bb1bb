#include "cachesim/line_ids.h"

#include <fmt/format.h>

#include <bit>

#include "trace/error.h"

namespace regather::cachesim {

LineIds::LineIds() : slots_(64), shift_(64 - std::countr_zero(slots_.size())) {}

std::uint32_t LineIds::operator()(Line line) {
    const auto number = static_cast<std::uint64_t>(line);
    Slot* slot = &slot_of(number);
    if (slot->id != empty) return slot->id;
    if (size_ == max_lines)
        throw trace::UsageError(
            fmt::format("lines: found more than {} different lines, expected fewer", max_lines));
    if (size_ >= slots_.size() / 4 * 3) {
        grow();
        slot = &slot_of(number);
    }
    *slot = {number, size_};
    return size_++;
}

LineIds::Slot& LineIds::slot_of(std::uint64_t line) {
    std::size_t at = line * 0x9e3779b97f4a7c15 >> shift_;
    while (slots_[at].id != empty && slots_[at].line != line) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
}

void LineIds::grow() {
    std::vector<Slot> former(2 * slots_.size());
    former.swap(slots_);
    --shift_;
    for (const Slot& slot : former)
        if (slot.id != empty) slot_of(slot.line) = slot;
}

}  // namespace regather::cachesim
