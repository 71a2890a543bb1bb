#include "cachesim/lru/line_stamps.h"

#include <algorithm>
#include <bit>

namespace regather::cachesim {

Stamps& LineStamps::grown(std::uint64_t line) {
    low_.resize(std::min(low_lines, std::bit_ceil(std::max<std::uint64_t>(line + 1, 4096))));
    return low_[line];
}

Stamps& LineStamps::hashed(std::uint64_t line) {
    return high_.enter(line);
}

}  // namespace regather::cachesim
