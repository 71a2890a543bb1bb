// spatial/photons/photon_tree.h -- the shape of a binary tree whose leaves hold photons, as a structure that
// is walked: what a replay needs of a kd-tree with buckets, without its geometry.
#pragma once
#include <string>
#include <vector>

#include "spatial/structure.h"

namespace regather::spatial {

/// Elements: the inner nodes from 0 (the root) on, then the leaves in depth-first order.
class PhotonTree final : public Structure {
public:
    /// children[2 i] and children[2 i + 1] are the lower and the upper child of inner node i: elements after
    /// it. Leaf l holds the photons at places leaf_begin[l] .. leaf_begin[l + 1] - 1. A tree without photons
    /// has no leaf: leaf_begin is {0}.
    PhotonTree(std::string name, std::vector<std::uint32_t> children, std::vector<std::uint32_t> leaf_begin);

    std::string_view name() const override { return name_; }
    std::uint32_t level(std::uint32_t element) const override { return level_[element]; }
    std::unique_ptr<WalkDecoder> decoder() const override;
    void append_children(std::uint32_t element, std::vector<std::uint32_t>& to) const override;
    std::vector<std::uint32_t> roots() const override;
    std::uint32_t records(std::uint32_t element) const override;
    std::uint32_t first_record(std::uint32_t element) const override {
        return leaf_begin_[element - inner_nodes()];
    }
    bool same_as(const Structure& other) const override;

    std::uint32_t inner_nodes() const { return static_cast<std::uint32_t>(children_.size() / 2); }
    std::uint32_t leaves() const { return static_cast<std::uint32_t>(leaf_begin_.size() - 1); }
    std::span<const std::uint32_t> children() const { return children_; }
    std::span<const std::uint32_t> leaf_begin() const { return leaf_begin_; }

private:
    std::string name_;
    std::vector<std::uint32_t> children_, leaf_begin_;
    std::vector<std::uint32_t> level_;
};

}  // namespace regather::spatial
