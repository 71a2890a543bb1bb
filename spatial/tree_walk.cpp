#include "spatial/tree_walk.h"

#include <algorithm>
#include <bit>

#include "spatial/walk_bits.h"

namespace regather::spatial {

TreeWalkDecoder::TreeWalkDecoder(std::span<const std::uint32_t> children, bool empty)
    : children_(children),
      inner_(static_cast<std::uint32_t>(children.size() / 2)),
      empty_(empty),
      visited_(4096),
      undecided_(64) {}

WalkDecoder::Visits TreeWalkDecoder::decode(std::span<const std::uint8_t> walk) {
    walk_bytes_ = 0;
    if (walk.empty()) return {WalkFault::none, {}};
    if (empty_) return {WalkFault::bytes_left_over, {}};
    if (padded_.size() < walk.size() + walk_padding) padded_.resize(2 * (walk.size() + walk_padding));
    std::memcpy(padded_.data(), walk.data(), walk.size());
    std::memset(padded_.data() + walk.size(), 0, walk_padding);
    const std::uint8_t* const bytes = padded_.data();
    const std::uint32_t* const children = children_.data();
    const std::uint64_t total = 8 * walk.size();

    std::uint64_t position = 0;
    std::size_t count = 0, depth = 0;
    std::uint32_t node = 0;
    for (;;) {
        // Down to a leaf by near bits; a further word of them below whole_bits levels.
        while (node < inner_) {
            if (position > total) return {WalkFault::ends_early, {visited_.data(), count}};
            std::uint64_t bits = bits_at(bytes, position);
            if (visited_.size() < count + whole_bits + 2) visited_.resize(2 * visited_.size());
            if (undecided_.size() < depth + whole_bits) undecided_.resize(2 * undecided_.size());
            std::uint32_t *const to = visited_.data() + count, *const far = undecided_.data() + depth;
            int steps = 0;
            do {
                const std::uint64_t upper = bits >> 63;
                to[steps] = node;
                far[steps] = children[2 * std::uint64_t{node} + (upper ^ 1)];
                node = children[2 * std::uint64_t{node} + upper];
                bits <<= 1;
                ++steps;
            } while (node < inner_ && steps < whole_bits);
            count += static_cast<std::size_t>(steps);
            depth += static_cast<std::size_t>(steps);
            position += static_cast<std::uint64_t>(steps);
        }
        if (visited_.size() <= count) visited_.resize(2 * visited_.size());
        visited_[count++] = node;
        // Far bits: a zero drops the deepest undecided child, a one enters it.
        bool entered = false;
        while (!entered && depth > 0) {
            if (position > total) return {WalkFault::ends_early, {visited_.data(), count}};
            const std::uint64_t bits = bits_at(bytes, position);
            const std::size_t zeros =
                std::min<std::size_t>({static_cast<std::size_t>(std::countl_zero(bits)), whole_bits, depth});
            depth -= zeros;
            position += zeros;
            if (depth == 0 || zeros == whole_bits) continue;
            ++position;
            node = undecided_[--depth];
            entered = true;
        }
        if (!entered) break;
    }
    if (position > total) return {WalkFault::ends_early, {visited_.data(), count}};
    walk_bytes_ = std::max<std::uint64_t>(1, (position + 7) / 8);
    if (walk_bytes_ < walk.size()) return {WalkFault::bytes_left_over, {visited_.data(), count}};
    return {WalkFault::none, {visited_.data(), count}};
}

}  // namespace regather::spatial
