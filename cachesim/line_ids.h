// cachesim/line_ids.h -- lines numbered 0, 1, 2, ... in the order of their first touch, so that what is known
// of a line can stand in a plain array. A hash table with open addresses: 16 bytes a slot, at most 3/4 full.
#pragma once
#include <cstdint>
#include <vector>

#include "cachesim/cache.h"

namespace regather::cachesim {

class LineIds {
public:
    LineIds();
    /// The line's id: size() as it was before the call, if this is the first touch. Throws trace::UsageError
    /// for more than max_lines different lines.
    std::uint32_t operator()(Line line);
    std::uint32_t size() const { return size_; }

    static constexpr std::uint32_t max_lines = 1u << 31;

private:
    struct Slot {
        std::uint64_t line = 0;
        std::uint32_t id = empty;
    };
    static constexpr std::uint32_t empty = ~std::uint32_t{0};
    Slot& slot_of(std::uint64_t line);
    void grow();

    std::vector<Slot> slots_;
    int shift_;
    std::uint32_t size_ = 0;
};

}  // namespace regather::cachesim
