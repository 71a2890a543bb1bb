// spatial/photons/photon_bvh.h -- a bounding volume hierarchy over photons: a tree of two children whose
// nodes hold the tight boxes of both. The photons are halved along the longest side of their box, as a
// kd-tree with buckets does (spatial/photons/bucket_kd.h); a search enters the nearer box first.
#pragma once
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "spatial/listed.h"
#include "spatial/photons/bucket_kd.h"
#include "spatial/photons/photon_octree.h"

namespace regather::spatial {

/// Elements: inner nodes, each before those below it, the root first; then the leaves.
class PhotonBvh {
public:
    static constexpr std::uint32_t node_bytes = 64;  ///< Two boxes of 24 bytes and two children of 4, padded.

    /// Leaves of at most `leaf_photons`, 1 to 64. Otherwise as BucketKd.
    PhotonBvh(std::span<const Photon> photons, std::uint32_t leaf_photons, std::string name = "bvh");

    std::shared_ptr<const Listed> share_structure() const { return structure_; }
    const PhotonParts& parts() const { return parts_; }
    std::uint32_t size() const { return parts_.size(); }
    std::uint32_t inner_nodes() const { return static_cast<std::uint32_t>(nodes_.size()); }
    struct Node {
        std::array<trace::Bounds3, 2> box;
        std::array<std::uint32_t, 2> child;  ///< Elements.
    };
    const Node& node(std::uint32_t element) const { return nodes_[element]; }

private:
    PhotonParts parts_;
    std::vector<Node> nodes_;
    std::shared_ptr<const Listed> structure_;
};

/// Fills `found` with the nearest photons of `point`: exact, equal distances by number.
template <class Listener = Unheard>
void nearest(const PhotonBvh& tree, Vec3 point, NearestSet& found, Listener&& listener = {}) {
    struct Pending {
        std::uint32_t element;
        float distance2;
    };
    found.clear();
    if (tree.size() == 0 || !trace::is_finite(point)) return;
    std::array<Pending, 64> stack;  // halves: fewer levels than a number of photons has bits
    std::size_t depth = 0;
    stack[depth++] = {0, 0};
    while (depth > 0) {
        Pending at = stack[--depth];
        if (at.distance2 > found.bound2()) continue;
        while (at.element < tree.inner_nodes()) {
            listener.visit(at.element);
            const PhotonBvh::Node& node = tree.node(at.element);
            const float lower = distance2(node.box[0], point), upper = distance2(node.box[1], point);
            const std::size_t near = upper < lower ? 1 : 0;
            stack[depth++] = {node.child[1 - near], std::max(lower, upper)};
            at = {node.child[near], std::min(lower, upper)};
            if (at.distance2 > found.bound2()) break;
        }
        if (at.element >= tree.inner_nodes() && at.distance2 <= found.bound2())
            tree.parts().read(at.element - tree.inner_nodes(), at.element, point, found, listener);
    }
}

}  // namespace regather::spatial
