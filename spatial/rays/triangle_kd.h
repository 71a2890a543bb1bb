// spatial/rays/triangle_kd.h -- a kd-tree over triangles, whose leaves are numbered depth-first: the labels
// by which the ordering `kd-leaf` sorts kNN queries (the paper, end of section 6.3.2). Splits by the surface
// area heuristic (MacDonald & Booth, "Heuristics for Ray Tracing Using Space Subdivision", 1990), swept
// exactly over events that are sorted once (Wald & Havran, "On Building Fast kd-Trees for Ray Tracing, and on
// Doing that in O(N log N)", 2006), with each triangle represented by its box. Lengths in scene units. Built
// on the calling thread; the tree depends on the input alone.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "spatial/rays/triangle.h"
#include "trace/bounds.h"
#include "trace/vec.h"

namespace regather::spatial {

/// The defaults are those of Wald & Havran, section 5; the automatic depth is Havran's.
struct TriangleKdConfig {
    std::uint32_t leaf_size = 1;   ///< A node with so many triangles or fewer is not split.
    std::uint32_t max_depth = 0;   ///< Of a leaf, the root's being 0; at most 64. 0: 8 + 1.3 log2(triangles).
    float traversal_cost = 15;     ///< Of one inner node; > 0.
    float intersection_cost = 20;  ///< Of one triangle; > 0.
    float empty_space_factor = 0.8f;  ///< On the cost of a split that leaves one side empty; in (0, 1].
};

struct TriangleKdStats {
    std::uint32_t inner_nodes = 0;
    std::uint32_t leaves = 0;
    std::uint32_t empty_leaves = 0;
    std::uint64_t references = 0;  ///< Triangles in leaves; one that straddles a plane counts on both sides.
    std::uint32_t depth = 0;       ///< Of the deepest leaf.
    friend bool operator==(const TriangleKdStats&, const TriangleKdStats&) = default;
};

class TriangleKd {
public:
    /// Throws trace::UsageError for a config out of range, trace::DataError as triangle_bounds() does.
    /// Without triangles, or when all lie on one axis-parallel line, the tree is a single leaf.
    TriangleKd(std::span<const trace::Vec3> vertices, std::span<const TriangleIndices> triangles,
               const TriangleKdConfig& config = {});

    /// The label of the leaf that the point lies in. A point on a split plane lies on the lower side; one
    /// outside the bounds falls where the descent leads it, as if moved to the nearest point of the bounds. A
    /// point with a NaN gets label 0.
    std::uint32_t leaf_of(trace::Vec3 point) const;

    /// Labels are 0 .. leaf_count() - 1, lower side of a plane before upper. Leaves without triangles count.
    std::uint32_t leaf_count() const { return stats_.leaves; }
    const TriangleKdStats& stats() const { return stats_; }
    const trace::Bounds3& bounds() const { return bounds_; }  ///< Of all triangles.

    /// By label. They tile bounds(); a point on a shared face lies in the lower one of the two.
    std::vector<trace::Bounds3> leaf_bounds() const;
    /// The triangles whose box overlaps the inside of the leaf, ascending. One that lies flat in a split
    /// plane is on the plane's lower side only.
    std::span<const std::uint32_t> triangles_of_leaf(std::uint32_t label) const;

private:
    friend class TriangleKdBuilder;
    struct Node {
        float split;  // Unused in a leaf.
        std::uint32_t
            next;  // Inner node: the upper child (the lower one follows its parent). Leaf: the label.
        std::uint32_t axis;  // leaf_axis in a leaf.
    };
    static constexpr std::uint32_t leaf_axis = 3;

    std::vector<Node> nodes_;  // Depth-first, lower side first.
    std::vector<std::uint64_t> leaf_begin_{0};
    std::vector<std::uint32_t> leaf_triangles_;
    trace::Bounds3 bounds_;
    TriangleKdStats stats_;
};

}  // namespace regather::spatial
