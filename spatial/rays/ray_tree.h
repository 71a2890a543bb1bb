// spatial/rays/ray_tree.h -- the shape of a hierarchy that rays are cast through (spatial/rays/ray_bvh.h), as
// a structure that is walked: what a replay needs of it, without its geometry.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "spatial/rays/ray_bvh.h"
#include "spatial/structure.h"

namespace regather::spatial {

/// Elements: the inner nodes from 0 (the root) on, then the leaves in depth-first order, Region::triangles,
/// then the places of a ray's stack that are not on chip, Region::stack, the lowest first. These hang below
/// no other element and are one level below the deepest one.
class RayTree final : public Structure {
public:
    static constexpr std::uint32_t most_levels = 64;  ///< Of inner nodes on one way down.

    struct Shape {
        std::uint32_t width = 8;  ///< Children of a node at most: 2, 4 or 8.
        /// `width` for each inner node, in the sequence of their slots; elements after it; 0: none, behind
        /// those that there are.
        std::vector<std::uint32_t> children = {};
        /// Leaf l holds the triangles at places leaf_begin[l] .. leaf_begin[l + 1] - 1; {0}: no leaf.
        std::vector<std::uint32_t> leaf_begin{0};
        bool quantised = false;  ///< The boxes of a node's children, to 8 bits a plane.
        friend bool operator==(const Shape&, const Shape&) = default;
    };
    /// How a ray's stack is kept.
    struct Stack {
        std::optional<std::uint32_t> on_chip;  ///< So many places, the lowest; none: all of them.
        bool any_hit = false;  ///< The search ends at the first hit and reads no more of the stack.
    };
    /// Throws trace::DataError for a shape of more than most_levels.
    RayTree(std::string name, Shape shape, Stack stack);

    std::string_view name() const override { return name_; }
    std::uint32_t level(std::uint32_t element) const override {
        return element < level_.size() ? level_[element] : deepest_ + 1;
    }
    std::unique_ptr<WalkDecoder> decoder() const override;
    void append_children(std::uint32_t element, std::vector<std::uint32_t>& to) const override;
    std::vector<std::uint32_t> roots() const override;
    /// The triangles of a leaf, else 1.
    std::uint32_t records(std::uint32_t element) const override;
    std::uint32_t first_record(std::uint32_t element) const override {
        return shape_.leaf_begin[element - inner_nodes()];
    }
    bool same_as(const Structure& other) const override;

    const Shape& shape() const { return shape_; }
    const Stack& stack() const { return stack_; }
    std::uint32_t inner_nodes() const {
        return static_cast<std::uint32_t>(shape_.children.size() / shape_.width);
    }
    std::uint32_t leaves() const { return static_cast<std::uint32_t>(shape_.leaf_begin.size() - 1); }
    /// Which child of its parent an element is.
    std::uint32_t slot(std::uint32_t element) const { return slot_[element]; }
    /// What a node takes at least with the boxes of its children. Planes as floats, and a number for each
    /// child: 64, 128 and 256 bytes for 2, 4 and 8 children. Quantised: 32, 64 and 80 (Ylitie et al. 2017,
    /// figure 2, for 8).
    std::uint32_t node_bytes() const;

private:
    std::string name_;
    Shape shape_;
    Stack stack_;
    std::uint32_t deepest_ = 0;
    std::vector<std::uint32_t> level_;  // of nodes and leaves
    std::vector<std::uint8_t> slot_;
};

/// The shape of a hierarchy with nodes of `width` children at most.
RayTree::Shape shape_of(const RayBvh& bvh, std::uint32_t width, bool quantised = false);

}  // namespace regather::spatial
