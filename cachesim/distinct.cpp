#include "cachesim/distinct.h"

#include <algorithm>

namespace regather::cachesim {

namespace {

constexpr std::uint64_t bitmap_lines = std::uint64_t{1} << 28;  // 32 MiB of bits at most

}  // namespace

void DistinctLines::add(std::span<const Line> lines) {
    for (const Line each : lines) {
        const std::uint64_t line = static_cast<std::uint64_t>(each);
        if (line >= bitmap_lines) {
            high_(each);
            continue;
        }
        const std::size_t word = line / 64;
        if (word >= low_.size())
            low_.resize(std::max(word + 1, std::min(2 * low_.size(), bitmap_lines / 64)));
        const std::uint64_t bit = std::uint64_t{1} << line % 64;
        low_count_ += (low_[word] & bit) == 0;
        low_[word] |= bit;
    }
}

}  // namespace regather::cachesim
