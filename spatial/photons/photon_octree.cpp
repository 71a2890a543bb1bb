#include "spatial/photons/photon_octree.h"

#include <cmath>
#include <numeric>

namespace regather::spatial {
namespace {

/// A cube from the lower corner on; where floats do not hold it, less.
trace::Bounds3 cube_over(std::span<const Photon> photons) {
    trace::Bounds3 box;
    for (const Photon& photon : photons) box.include(photon.position);
    const float side = trace::max_component(box.extent());
    for (int axis = 0; axis < 3; ++axis)
        if (const float end = box.min[axis] + side; std::isfinite(end))
            box.max[axis] = std::max(box.max[axis], end);
    return box;
}

float middle(float low, float high) {
    return std::clamp(low * 0.5f + high * 0.5f, low, high);
}

std::uint32_t octant_with(const trace::Bounds3& box, Vec3 point) {
    std::uint32_t octant = 0;
    for (int axis = 0; axis < 3; ++axis)
        octant =
            octant << 1 | static_cast<std::uint32_t>(point[axis] >= middle(box.min[axis], box.max[axis]));
    return octant;
}

}  // namespace

trace::Bounds3 PhotonOctree::octant_of(const trace::Bounds3& box, std::uint32_t octant) {
    trace::Bounds3 part = box;
    for (int axis = 0; axis < 3; ++axis)
        ((octant >> (2 - axis) & 1) != 0 ? part.min : part.max)[axis] = middle(box.min[axis], box.max[axis]);
    return part;
}

struct PhotonOctree::Builder {
    PhotonOctree& tree;
    std::span<const Photon> photons;
    std::uint32_t leaf_photons;
    std::vector<std::vector<Child>> children;  // by inner node
    std::vector<std::uint32_t> parent, part_parent;

    /// `items`: photons of the box, ascending. Returns what there is, without its octant.
    Child build(std::span<std::uint32_t> items, const trace::Bounds3& box, std::uint32_t level,
                std::uint32_t above) {
        if (items.size() <= leaf_photons || level == most_levels || all_in_one_place(items)) {
            const std::uint32_t first = tree.parts_.count();
            tree.parts_.add(items, photons);
            part_parent.resize(tree.parts_.count(), above);
            return {0, first, tree.parts_.count()};
        }
        const auto node = static_cast<std::uint32_t>(children.size());
        children.emplace_back();
        parent.push_back(level == 0 ? node : above);
        auto begin = items.begin();
        for (std::uint32_t octant = 0; octant < 8; ++octant) {
            const auto end = std::stable_partition(begin, items.end(), [&](std::uint32_t photon) {
                return octant_with(box, photons[photon].position) == octant;
            });
            if (begin == end) continue;
            Child child = build({begin, end}, octant_of(box, octant), level + 1, node);
            child.octant = octant;
            children[node].push_back(child);
            begin = end;
        }
        return {0, node, 0};
    }
    bool all_in_one_place(std::span<const std::uint32_t> items) const {
        return std::all_of(items.begin(), items.end(), [&](std::uint32_t photon) {
            return photons[photon].position == photons[items.front()].position;
        });
    }
};

PhotonOctree::PhotonOctree(std::span<const Photon> photons, std::uint32_t leaf_photons, std::string name) {
    check_photons(photons);
    Listed::Elements elements;
    if (!photons.empty()) {
        box_ = cube_over(photons);
        std::vector<std::uint32_t> items(photons.size());
        std::iota(items.begin(), items.end(), 0u);
        Builder builder{*this, photons, leaf_photons, {}, {}, {}};
        builder.build(items, box_, 0, 0);
        for (const std::vector<Child>& children : builder.children) {
            children_.insert(children_.end(), children.begin(), children.end());
            child_begin_.push_back(static_cast<std::uint32_t>(children_.size()));
        }
        const std::uint32_t inner = inner_nodes();
        if (inner > 0) elements.ranges.push_back({trace::Region::nodes, 0, inner});
        elements.ranges.push_back({trace::Region::photons, inner, parts_.count()});
        elements.parent = builder.parent;
        for (std::uint32_t part = 0; part < parts_.count(); ++part)
            elements.parent.push_back(inner > 0 ? builder.part_parent[part] : part);
    }
    elements.record_begin.assign(parts_.begin().begin(), parts_.begin().end());
    elements.node_bytes = node_bytes;
    structure_ = std::make_shared<Listed>(std::move(name), std::move(elements));
}

}  // namespace regather::spatial
