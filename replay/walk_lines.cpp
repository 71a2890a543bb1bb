#include "replay/walk_lines.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace regather::replay {

using cachesim::Line;

WalkLines::WalkLines(const Layout& layout, std::uint32_t line_bytes)
    : layout_(&layout), shift_(std::countr_zero(line_bytes)), first_line_(layout.first_byte() >> shift_) {
    const std::uint64_t last =
        std::max(layout.first_byte(), layout.end_byte() - (layout.end_byte() > 0 ? 1 : 0));
    entry_.resize((last >> shift_) - first_line_ + 1);
}

std::span<const Line> WalkLines::touches(std::span<const std::uint32_t> elements) {
    std::size_t most = elements.size() * ((std::size_t{layout_->widest()} >> shift_) + 2);
    if (touches_.size() < most) {
        // Few elements may be as wide as the widest.
        most = 2 * elements.size() + (layout_->bytes(elements) >> shift_);
        if (touches_.size() < most) touches_.resize(2 * most);
    }
    Line* to = touches_.data();
    layout_->for_each(elements, [&](std::uint32_t, std::uint64_t address, std::uint32_t bytes) {
        const std::uint64_t first = address >> shift_, last = (address + bytes - 1) >> shift_;
        *to++ = Line{first};
        *to = Line{last};  // overwritten when it is the same
        to += static_cast<int>(last != first);
        if (last - first > 1) {
            --to;
            for (std::uint64_t line = first + 1; line <= last; ++line) *to++ = Line{line};
        }
    });
    return {touches_.data(), to};
}

WalkLines::First WalkLines::first(std::span<const Line> touches) {
    const std::size_t words = touches.size() / 64 + 1;
    if (lines_.size() <= touches.size()) {
        lines_.resize(2 * touches.size() + 1);
        last_.resize(2 * touches.size() + 1);
        is_last_.resize(2 * words + 1);
        before_.resize(2 * words + 1);
    }
    if (base_ > std::numeric_limits<std::uint32_t>::max() - touches.size()) {
        std::fill(entry_.begin(), entry_.end(), 0);
        base_ = 1;
    }
    std::uint32_t* const entries = entry_.data();
    Line* const lines = lines_.data();
    std::uint32_t* const last = last_.data();
    const std::uint64_t first_line = first_line_;
    const std::uint32_t base = base_;
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < touches.size(); ++i) {
        std::uint32_t& entry = entries[static_cast<std::uint64_t>(touches[i]) - first_line];
        const std::uint32_t met = entry, fresh = met < base ? 1 : 0;
        const std::uint32_t at =
            met ^ ((met ^ (base + count)) & (0 - fresh));  // without a branch: nobody could foretell it
        entry = at;
        lines[at - base] = touches[i];
        last[at - base] = static_cast<std::uint32_t>(i);
        count += fresh;
    }
    base_ += count;

    std::fill_n(is_last_.data(), words, 0);
    for (std::uint32_t i = 0; i < count; ++i) is_last_[last[i] / 64] |= std::uint64_t{1} << (last[i] % 64);
    std::uint32_t sum = 0;
    for (std::size_t w = 0; w < words; ++w) {
        before_[w] = sum;
        sum += static_cast<std::uint32_t>(std::popcount(is_last_[w]));
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t word = last[i] / 64, bit = last[i] % 64;
        last[i] = before_[word] +
                  static_cast<std::uint32_t>(std::popcount(is_last_[word] & ((std::uint64_t{1} << bit) - 1)));
    }
    return {{lines, count}, {last, count}};
}

}  // namespace regather::replay
