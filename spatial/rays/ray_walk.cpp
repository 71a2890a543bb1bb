#include "spatial/rays/ray_walk.h"

#include <algorithm>

#include "spatial/walk_bits.h"

namespace regather::spatial {
namespace {

/// A node some of whose entered children wait.
class Waiting {
public:
    Waiting() = default;
    Waiting(std::uint32_t node, std::uint64_t left, unsigned gone_to)
        : word_(node | left << 32 | std::uint64_t{1} << (40 + gone_to)) {}
    std::uint32_t node() const { return static_cast<std::uint32_t>(word_); }
    std::uint32_t left() const { return static_cast<std::uint32_t>(word_ >> 32 & 0xff); }
    bool has_gone_to(unsigned slot) const { return (word_ >> (40 + slot) & 1) != 0; }
    void go_to(unsigned slot) {
        word_ -= std::uint64_t{1} << 32;
        word_ |= std::uint64_t{1} << (40 + slot);
    }

private:
    std::uint64_t word_ = 0;
};

template <unsigned slot_bits, bool spills>
class RayWalkDecoder final : public WalkDecoder {
public:
    explicit RayWalkDecoder(const RayTree& tree)
        : children_(tree.shape().children.data()),
          inner_(tree.inner_nodes()),
          empty_(tree.leaves() == 0),
          any_hit_(tree.stack().any_hit),
          on_chip_(tree.stack().on_chip.value_or(0)),
          first_place_(tree.range_of(trace::Region::stack).first),
          visited_(8 * step) {}

    Visits decode(std::span<const std::uint8_t> walk) override {
        walk_bytes_ = 0;
        count_ = 0;
        height_ = 0;
        if (walk.empty()) return told(WalkFault::none);
        if (empty_) return told(WalkFault::bytes_left_over);
        if (padded_.size() < walk.size() + walk_padding) padded_.resize(2 * (walk.size() + walk_padding));
        std::memcpy(padded_.data(), walk.data(), walk.size());
        std::memset(padded_.data() + walk.size(), 0, walk_padding);
        const std::uint64_t total = 8 * walk.size();

        WalkBits bits(padded_.data());
        std::size_t depth = 0;
        std::uint32_t element = 0;
        for (;;) {
            if (bits.position > total) return told(WalkFault::ends_early);
            if (visited_.size() < count_ + step) visited_.resize(2 * visited_.size());
            visited_[count_++] = element;
            if (element < inner_) {
                if (bits.left < 2 * slot_bits + 1) bits.refill();
                const std::uint64_t entered = bits.word >> (63 - slot_bits);
                bits.take(slot_bits + 1);
                if (entered > 0) {
                    const std::uint32_t* const row = children_ + (std::uint64_t{element} << slot_bits);
                    const auto slot = static_cast<unsigned>(bits.word >> (64 - slot_bits));
                    bits.take(slot_bits);
                    if (entered > 1u << slot_bits || row[entered - 1] == 0 || row[slot] == 0)
                        return told(bits.position > total ? WalkFault::ends_early
                                                          : WalkFault::enters_missing_child);
                    if (entered > 1) {
                        waiting_[depth++] = Waiting(element, entered - 1, slot);
                        put_aside(entered - 1);
                    }
                    element = row[slot];
                    continue;
                }
            }
            // The deepest node whose children wait: a zero drops them, a one and a slot goes to one.
            bool gone = false;
            while (!gone && depth > 0) {
                if (bits.position > total) return told(WalkFault::ends_early);
                const auto zeros = static_cast<unsigned>(std::min<std::size_t>(
                    {static_cast<std::size_t>(std::countl_zero(bits.word)), bits.left, depth}));
                for (std::size_t z = 0; spills && z < zeros; ++z) drop(waiting_[depth - 1 - z].left());
                depth -= zeros;
                bits.take(zeros);
                if (depth == 0) break;
                if (bits.left < 1 + slot_bits) {
                    bits.refill();
                    continue;
                }
                Waiting& at = waiting_[depth - 1];
                const auto slot = static_cast<unsigned>(bits.word << 1 >> (64 - slot_bits));
                bits.take(1 + slot_bits);
                element = children_[(std::uint64_t{at.node()} << slot_bits) + slot];
                if (element == 0 || at.has_gone_to(slot))
                    return told(bits.position > total ? WalkFault::ends_early
                                                      : WalkFault::enters_missing_child);
                if constexpr (spills) take();
                if (at.left() == 1)
                    --depth;
                else
                    at.go_to(slot);
                gone = true;
            }
            if (!gone) break;
        }
        if (bits.position > total) return told(WalkFault::ends_early);
        walk_bytes_ = std::max<std::uint64_t>(1, (bits.position + 7) / 8);
        return told(walk_bytes_ < walk.size() ? WalkFault::bytes_left_over : WalkFault::none);
    }

private:
    /// A step visits an element and writes and reads no more than the stack holds.
    static constexpr std::size_t step = 2 + 2 * 7 * RayTree::most_levels;

    Visits told(WalkFault fault) const { return {fault, {visited_.data(), count_}}; }
    void touch(std::uint32_t height) {
        if (height >= on_chip_) visited_[count_++] = first_place_ + (height - on_chip_);
    }
    void put_aside(std::uint64_t children) {
        if constexpr (spills)
            for (; children > 0; --children) touch(height_++);
    }
    void take() { touch(--height_); }
    void drop(std::uint32_t children) {
        if (any_hit_)
            height_ -= children;
        else
            for (; children > 0; --children) take();
    }

    const std::uint32_t* children_;
    std::uint32_t inner_;
    bool empty_, any_hit_;
    std::uint32_t on_chip_, first_place_;
    std::uint32_t height_ = 0;
    std::size_t count_ = 0;
    std::vector<std::uint8_t> padded_;  // the walk, and zeros
    std::vector<std::uint32_t> visited_;
    std::array<Waiting, RayTree::most_levels> waiting_;
};

template <unsigned slot_bits>
std::unique_ptr<WalkDecoder> made(const RayTree& tree) {
    if (tree.range_of(trace::Region::stack).count > 0)
        return std::make_unique<RayWalkDecoder<slot_bits, true>>(tree);
    return std::make_unique<RayWalkDecoder<slot_bits, false>>(tree);
}

}  // namespace

RayWalkRecorder::RayWalkRecorder(const RayTree& tree)
    : places_(tree.inner_nodes() + tree.leaves()),
      inner_(tree.inner_nodes()),
      slot_bits_(static_cast<std::uint32_t>(std::countr_zero(tree.shape().width))) {
    for (std::uint32_t e = 0; e < places_.size(); ++e)
        places_[e] = static_cast<std::uint16_t>(tree.level(e) << 3 | tree.slot(e));
}

std::unique_ptr<WalkDecoder> ray_walk_decoder(const RayTree& tree) {
    switch (tree.shape().width) {
        case 2:
            return made<1>(tree);
        case 4:
            return made<2>(tree);
        default:
            return made<3>(tree);
    }
}

}  // namespace regather::spatial
