#include "cachesim/line_stamps.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace regather::cachesim {

Stamps& LineStamps::grown(std::uint64_t line) {
    low_.resize(std::min(low_lines, std::bit_ceil(std::max<std::uint64_t>(line + 1, 4096))));
    return low_[line];
}

LineStamps::Slot& LineStamps::slot_of(std::uint64_t line) {
    const std::uint64_t mask = high_.size() - 1;
    std::uint64_t at = (line * 0x9E3779B97F4A7C15u) >> (64 - std::countr_zero(high_.size()));
    while (high_[at].stamps.all != 0 && high_[at].line != line) at = (at + 1) & mask;
    return high_[at];
}

Stamps& LineStamps::hashed(std::uint64_t line) {
    if (2 * (taken_ + 1) > high_.size()) {
        std::vector<Slot> old =
            std::exchange(high_, std::vector<Slot>(std::max<std::size_t>(4096, 2 * high_.size())));
        for (const Slot& slot : old)
            if (slot.stamps.all != 0) slot_of(slot.line) = slot;
    }
    Slot& slot = slot_of(line);
    if (slot.stamps.all == 0) {
        slot.line = line;
        ++taken_;
    }
    return slot.stamps;
}

}  // namespace regather::cachesim
