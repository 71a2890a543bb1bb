// spatial/tree_walk.h -- walks (spatial/walk.h) over a binary tree of any shape whose inner nodes have two
// children each.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "spatial/structure.h"

namespace regather::spatial {

/// Inner nodes are the elements 0 .. inner - 1, the root is 0, every further element is a leaf. A leaf has no
/// bits; an inner node has a near bit and, when its near subtree is done, a far bit.
class TreeWalkDecoder final : public WalkDecoder {
public:
    /// children[2 i] and children[2 i + 1] are the lower and the upper child of inner node i; they outlive
    /// the decoder. A tree of one leaf has no children, one of nothing is `empty`.
    TreeWalkDecoder(std::span<const std::uint32_t> children, bool empty);

    Visits decode(std::span<const std::uint8_t> walk) override;

private:
    std::span<const std::uint32_t> children_;
    std::uint32_t inner_;
    bool empty_;
    std::vector<std::uint8_t> padded_;  // the walk, and zeros
    std::vector<std::uint32_t> visited_, undecided_;
};

}  // namespace regather::spatial
