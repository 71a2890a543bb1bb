#include "replay/layout.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace regather::replay {

Layout::Layout(std::string name, const spatial::Structure& structure, std::uint64_t base,
               std::uint32_t stride_bytes, std::uint32_t used_bytes)
    : name_(std::move(name)),
      ranges_(structure.ranges().begin(), structure.ranges().end()),
      stride_bytes_(stride_bytes),
      widest_(used_bytes) {
    if (ranges_.empty()) return;
    const std::uint64_t first = ranges_.front().first;
    origin_ = base - first * stride_bytes;
    first_byte_ = base;
    end_byte_ = base + (structure.end() - 1 - first) * stride_bytes + used_bytes;
}

Layout::Layout(std::string name, const spatial::Structure& structure, std::vector<Extent> extents)
    : name_(std::move(name)),
      ranges_(structure.ranges().begin(), structure.ranges().end()),
      extents_(std::move(extents)) {
    assert(extents_.size() == structure.end());
    first_byte_ = std::numeric_limits<std::uint64_t>::max();
    for (const Extent& extent : extents_) {
        if (extent.bytes == 0) continue;
        first_byte_ = std::min(first_byte_, extent.address);
        end_byte_ = std::max(end_byte_, extent.address + extent.bytes);
        widest_ = std::max(widest_, extent.bytes);
    }
    if (end_byte_ == 0) first_byte_ = 0;
}

std::uint64_t Layout::bytes(std::span<const std::uint32_t> elements) const {
    if (extents_.empty()) return std::uint64_t{widest_} * elements.size();
    std::uint64_t sum = 0;
    for (const std::uint32_t e : elements) sum += extents_[e].bytes;
    return sum;
}

Layout heap_20(const spatial::Structure& structure) {
    return {"heap-20", structure, 0, 20, 20};
}

}  // namespace regather::replay
