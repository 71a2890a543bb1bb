// cachesim/line_ids.h -- lines numbered 0, 1, 2, ... in the order of their first touch, so that what is known
// of a line can stand in a plain array.
#pragma once
#include <cstdint>

#include "cachesim/cache.h"
#include "cachesim/line_table.h"

namespace regather::cachesim {

class LineIds {
public:
    /// The line's id: size() as it was before the call, if this is the first touch. Throws trace::UsageError
    /// for more than max_lines different lines.
    std::uint32_t operator()(Line line);
    std::uint32_t size() const { return static_cast<std::uint32_t>(ids_.size()); }

    static constexpr std::uint32_t max_lines = 1u << 31;

private:
    struct Id {
        std::uint32_t number = ~std::uint32_t{0};
        bool free() const { return number == ~std::uint32_t{0}; }
    };
    LineTable<Id> ids_;
};

}  // namespace regather::cachesim
