// replay/walk_lines.h -- the cache lines that a walk touches: all of them in order, and each one's first
// touch.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/cache.h"
#include "replay/layout.h"

namespace regather::replay {

/// One thread at a time.
class WalkLines {
public:
    /// line_bytes is a power of two. The layout outlives it.
    WalkLines(const Layout& layout, std::uint32_t line_bytes);

    std::uint32_t line_bytes() const { return std::uint32_t{1} << shift_; }

    /// An element on two lines touches both, the lower one first. Valid until the next call.
    std::span<const cachesim::Line> touches(std::span<const std::uint32_t> elements);

    /// What LruFamily::access_first() takes: the different lines in the order of their first touches, and the
    /// place of each in the order of their last touches.
    struct First {
        std::span<const cachesim::Line> lines;
        std::span<const std::uint32_t> last_rank;
    };
    /// `touches` as from touches(). Valid until the next call.
    First first(std::span<const cachesim::Line> touches);

private:
    const Layout* layout_;
    int shift_;
    std::uint64_t first_line_;
    std::vector<cachesim::Line> touches_;
    std::uint32_t base_ = 1;  // entries from here on are of this walk: base_ + place among its lines
    std::vector<std::uint32_t> entry_;    // by line from first_line_ on
    std::vector<cachesim::Line> lines_;   // of the walk, in the order of first touches
    std::vector<std::uint32_t> last_;     // place of the last touch, then its rank
    std::vector<std::uint64_t> is_last_;  // by place of a touch: a bitmap
    std::vector<std::uint32_t> before_;   // last touches before each of its words
};

}  // namespace regather::replay
