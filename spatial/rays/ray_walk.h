// spatial/rays/ray_walk.h -- the walk of a ray as bits, and back: which children the boxes let it enter, and
// which of them it went to, in its order. No geometry is needed to read them.
//
// Grammar (bits from the most significant of each byte; a walk starts on a byte and is padded with zeros; b
// bits tell the slots of a node: 1, 2 or 3 for 2, 4 or 8 children). A ray that is not cast has a walk of no
// bytes; any other walk has at least one byte.
//   walk(element): it is visited; nothing more if it is a leaf, whose triangles are tested, else
//   b + 1 bits: how many of its children are entered; if any, b bits: the slot of the first one, and its
//   walk; then for each further one: 1, b bits: its slot, and its walk; or 0: all that still wait are
//   dropped, because a hit lies before them, or because any hit was enough.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "spatial/rays/ray_tree.h"
#include "spatial/structure.h"
#include "spatial/walk.h"

namespace regather::spatial {

/// Listens to closest() and occluded() and appends walks to one byte buffer.
class RayWalkRecorder {
public:
    /// The tree is that of the hierarchy that is cast through, and outlives the recorder.
    explicit RayWalkRecorder(const RayTree& tree);

    void node(std::uint32_t number) { visit(number); }
    void entered(unsigned children) {
        bits_.push(children, slot_bits_ + 1);
        first_ = children > 0;
        left_[level_] = static_cast<std::uint8_t>(children);
        waiting_ |= std::uint64_t{first_} << level_;
    }
    void block(std::uint32_t number) {
        last_leaf_ = number;
        visit(inner_ + number);
    }
    /// Ends a walk; returns its bytes.
    std::uint32_t finish() {
        bits_.push(0, static_cast<unsigned>(std::popcount(waiting_)));
        waiting_ = 0;
        return bits_.finish();
    }
    std::span<const std::uint8_t> bytes() const { return bits_.bytes(); }
    /// Nodes and leaves.
    std::uint64_t visited() const { return bits_.visited_nodes(); }
    /// Of the last block.
    std::uint32_t last_leaf() const { return last_leaf_; }

private:
    void visit(std::uint32_t element) {
        bits_.visit(element);
        const std::uint32_t place = places_[element];
        level_ = place >> 3;
        if (level_ == 0) return;
        if (level_ < 64) {  // what waits below has been dropped
            bits_.push(0, static_cast<unsigned>(std::popcount(waiting_ >> level_)));
            waiting_ &= (std::uint64_t{1} << level_) - 1;
        }
        bits_.push((first_ ? 0u : 1u << slot_bits_) | (place & 7), slot_bits_ + (first_ ? 0u : 1u));
        first_ = false;
        const std::uint32_t parent = level_ - 1;
        if (--left_[parent] == 0) waiting_ &= ~(std::uint64_t{1} << parent);
    }

    WalkRecorder bits_;
    std::vector<std::uint16_t> places_;  // by element: level and slot
    std::uint32_t inner_, slot_bits_;
    std::uint32_t level_ = 0, last_leaf_ = 0;
    std::uint64_t waiting_ = 0;  // by level: whether children of the open node there wait
    bool first_ = false;         // the next element is the first child of the last one
    std::array<std::uint8_t, RayTree::most_levels + 1> left_{};  // by level
};

/// Gives a tree's walks back as elements; of a tree with a stack in memory, each of its places when an entry
/// is written there and when it is read: a child that waits lies on top of those before it, and is read when
/// it is gone to, and when it is dropped unless any hit was enough. The tree outlives the decoder.
std::unique_ptr<WalkDecoder> ray_walk_decoder(const RayTree& tree);

}  // namespace regather::spatial
