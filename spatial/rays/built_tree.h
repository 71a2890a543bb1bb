// spatial/rays/built_tree.h -- a bounding volume hierarchy over boxes as Embree 3's rtcBuildBVH makes it
// (binned surface area heuristic, no spatial splits: each box lies in exactly one leaf), before it gets a
// form of its own. Built on one thread; Embree's kernels are not involved, and its builder divides where they
// take approximate reciprocals, so the tree depends on the input alone. Lengths in scene units.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "trace/bounds.h"

namespace regather::spatial {

struct BuildConfig {
    std::uint32_t most_children = 2;  ///< Of an inner node; 2 to 8.
    std::uint32_t leaf_size = 4;      ///< Boxes in a leaf at most; 1 to 32.
    std::uint32_t block_size = 1;     ///< Boxes that are tested for the price of one.
    float traversal_cost = 1;         ///< Of one inner node; > 0.
    float intersection_cost = 1;      ///< Of one block of boxes; > 0.
};

/// An inner node has 2 to most_children children and no boxes, a leaf has boxes and no children.
struct BuiltNode {
    std::array<BuiltNode*, 8> children{};
    std::uint32_t child_count = 0;
    std::uint32_t lowest = 0;          ///< The smallest number of a box below.
    std::span<std::uint32_t> numbers;  ///< Of the leaf's boxes, ascending.
    trace::Bounds3 bounds;             ///< Tight.
};

class BuiltTree {
public:
    /// The deepest leaf's depth at most, the root's being 0. Deeper than Embree's default of 32, which small
    /// triangles in a vast scene reach.
    static constexpr std::uint32_t max_depth = 64;

    /// Throws std::runtime_error with Embree's message when Embree fails. The order of a node's children is
    /// Embree's.
    BuiltTree(std::span<const trace::Bounds3> boxes, const BuildConfig& config);
    ~BuiltTree();
    BuiltTree(const BuiltTree&) = delete;
    BuiltTree& operator=(const BuiltTree&) = delete;

    BuiltNode* root() const { return root_; }  ///< Null without boxes.

    /// Makes wider nodes of a binary tree: from the root down, a node takes in the children of the inner
    /// child of the largest surface, the first of equal ones, until it has `width` children, 2 to 8 (Wald,
    /// Benthin, Boulos: "Getting Rid of Packets", 2008). Leaves stay as they are.
    void collapse(std::uint32_t width);

private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
    BuiltNode* root_ = nullptr;
};

}  // namespace regather::spatial
