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
    const std::uint32_t* const children = children_.data();
    const std::uint64_t total = 8 * walk.size();

    WalkBits bits(padded_.data());
    const auto refill = [&] {
        bits.refill();
        return bits.position <= total;
    };
    std::size_t count = 0, depth = 0;
    std::uint32_t node = 0;
    for (;;) {
        // Down to a leaf by near bits; a further word of them below so many levels. Where the last inner node
        // has two leaves its far bit is taken with them, without a branch that depends on it.
        std::uint64_t two_leaves = 0;
        while (node < inner_) {
            if (bits.left < 32 && !refill()) return {WalkFault::ends_early, {visited_.data(), count}};
            if (visited_.size() < count + whole_bits + 2) visited_.resize(2 * visited_.size());
            if (undecided_.size() < depth + whole_bits) undecided_.resize(2 * undecided_.size());
            std::uint32_t *const to = visited_.data() + count, *const undecided = undecided_.data() + depth;
            unsigned steps = 0;
            do {
                const std::uint64_t upper = bits.word >> 63;
                to[steps] = node;
                const std::uint32_t far = children[2 * std::uint64_t{node} + (upper ^ 1)];
                undecided[steps] = far;
                two_leaves = far >= inner_;
                node = children[2 * std::uint64_t{node} + upper];
                bits.word <<= 1;
                ++steps;
            } while (node < inner_ && steps < bits.left - 1);
            count += steps;
            depth += steps;
            bits.count(steps);
        }
        if (visited_.size() < count + 2) visited_.resize(2 * visited_.size());
        visited_[count] = node;
        visited_[count + 1] = undecided_[depth - two_leaves];
        count += 1 + (two_leaves & bits.word >> 63);
        depth -= two_leaves;
        bits.take(static_cast<unsigned>(two_leaves));
        // Far bits: a zero drops the deepest undecided child, a one enters it.
        bool entered = false;
        while (!entered && depth > 0) {
            const auto zeros = static_cast<unsigned>(std::min<std::size_t>(
                {static_cast<std::size_t>(std::countl_zero(bits.word)), bits.left, depth}));
            depth -= zeros;
            bits.take(zeros);
            if (depth == 0) break;
            if (bits.left > 0) {
                node = undecided_[--depth];
                bits.take(1);
                entered = true;
            } else if (!refill()) {
                return {WalkFault::ends_early, {visited_.data(), count}};
            }
        }
        if (!entered) break;
    }
    if (bits.position > total) return {WalkFault::ends_early, {visited_.data(), count}};
    walk_bytes_ = std::max<std::uint64_t>(1, (bits.position + 7) / 8);
    if (walk_bytes_ < walk.size()) return {WalkFault::bytes_left_over, {visited_.data(), count}};
    return {WalkFault::none, {visited_.data(), count}};
}

}  // namespace regather::spatial
