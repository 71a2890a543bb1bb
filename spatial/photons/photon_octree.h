// spatial/photons/photon_octree.h -- photons sorted along the Morton curve, and an octree of pointers over
// them: what an out-of-core renderer pages in by nodes and runs of photons (Christensen & Batali, "An
// Irradiance Atlas for Global Illumination in Complex Production Scenes", 2004, keep such octrees on disk). A
// search enters the nearest of a node's octants first.
#pragma once
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "spatial/listed.h"
#include "spatial/photons/photon_parts.h"
#include "trace/bounds.h"

namespace regather::spatial {

/// Elements: inner nodes, each before those below it, the root first; then the leaves' photons in parts.
class PhotonOctree {
public:
    static constexpr std::uint32_t node_bytes =
        8;  ///< Which octants there are, which are leaves, where they begin.

    static constexpr std::uint32_t most_levels = 21;  ///< Below it a leaf holds what there is.

    /// Splits a cube in halves along each axis until at most `leaf_photons` are left, 1 to 64; the i-th
    /// photon is node i of what a search finds. Throws as check_photons().
    PhotonOctree(std::span<const Photon> photons, std::uint32_t leaf_photons, std::string name = "octree");

    /// What lies in an octant: an inner node, or parts.
    struct Child {
        std::uint32_t octant;      ///< 4: the upper half along x, 2: y, 1: z.
        std::uint32_t first, end;  ///< Parts; or an inner node, where end is 0.
    };
    std::shared_ptr<const Listed> share_structure() const { return structure_; }
    const PhotonParts& parts() const { return parts_; }
    std::uint32_t size() const { return parts_.size(); }
    std::uint32_t inner_nodes() const { return static_cast<std::uint32_t>(child_begin_.size() - 1); }
    std::span<const Child> children(std::uint32_t node) const {
        return std::span(children_).subspan(child_begin_[node], child_begin_[node + 1] - child_begin_[node]);
    }
    const trace::Bounds3& box() const { return box_; }
    /// The part of a node's box that an octant is.
    static trace::Bounds3 octant_of(const trace::Bounds3& box, std::uint32_t octant);

private:
    struct Builder;
    trace::Bounds3 box_;
    PhotonParts parts_;
    std::vector<std::uint32_t> child_begin_{0};
    std::vector<Child> children_;
    std::shared_ptr<const Listed> structure_;
};

/// From a point to a box, squared: never more than what is computed in the same way to a point inside.
inline float distance2(const trace::Bounds3& box, Vec3 point) {
    Vec3 d;
    for (int axis = 0; axis < 3; ++axis)
        d[axis] = std::max({box.min[axis] - point[axis], point[axis] - box.max[axis], 0.0f});
    return trace::dot(d, d);
}

/// Fills `found` with the nearest photons of `point`: exact, equal distances by number.
template <class Listener = Unheard>
void nearest(const PhotonOctree& tree, Vec3 point, NearestSet& found, Listener&& listener = {}) {
    found.clear();
    if (tree.size() == 0 || !trace::is_finite(point)) return;
    const auto read = [&](std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t part = first; part < end; ++part)
            tree.parts().read(part, tree.inner_nodes() + part, point, found, listener);
    };
    if (tree.inner_nodes() == 0) return read(0, tree.parts().count());
    const auto enter = [&](const auto& self, std::uint32_t node, const trace::Bounds3& box) -> void {
        listener.visit(node);
        struct Candidate {
            float distance2;
            const PhotonOctree::Child* child;
            trace::Bounds3 box;
        };
        std::array<Candidate, 8> candidates;
        std::size_t count = 0;
        for (const PhotonOctree::Child& child : tree.children(node)) {
            const trace::Bounds3 octant = PhotonOctree::octant_of(box, child.octant);
            candidates[count++] = {spatial::distance2(octant, point), &child, octant};
        }
        std::sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(count),
                  [](const Candidate& a, const Candidate& b) {
                      return a.distance2 < b.distance2 ||
                             (a.distance2 == b.distance2 && a.child->octant < b.child->octant);
                  });
        for (std::size_t c = 0; c < count && candidates[c].distance2 <= found.bound2(); ++c) {
            const PhotonOctree::Child& child = *candidates[c].child;
            if (child.end == 0)
                self(self, child.first, candidates[c].box);
            else
                read(child.first, child.end);
        }
    };
    enter(enter, 0, tree.box());
}

}  // namespace regather::spatial
