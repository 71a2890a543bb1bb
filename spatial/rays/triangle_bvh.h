// spatial/rays/triangle_bvh.h -- a bounding volume hierarchy over triangles, whose leaves are numbered
// depth-first: the variant of the ordering `kd-leaf` (the paper, end of section 6.3.2) for a renderer that
// casts rays through a BVH. Built by Embree 3's rtcBuildBVH (binary, binned surface area heuristic, no
// spatial splits: each triangle lies in exactly one leaf). Of two children, the one whose centre is lower on
// the axis that separates the centres most comes first, so that, as in a kd-tree, labels run along space;
// Embree itself leaves the order of children open. Lengths in scene units. Built on one thread; the labels
// depend on the input alone.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "spatial/rays/triangle.h"
#include "trace/vec.h"

namespace regather::spatial {

struct TriangleBvhConfig {
    std::uint32_t leaf_size = 4;  ///< Triangles in a leaf at most; 1 to 32.
    float traversal_cost = 1;     ///< Of one inner node; > 0.
    float intersection_cost = 1;  ///< Of one triangle; > 0.
};

class TriangleBvh {
public:
    /// Throws trace::UsageError for a config out of range, trace::DataError as triangle_bounds() does, and
    /// std::runtime_error with Embree's message when Embree fails.
    TriangleBvh(std::span<const trace::Vec3> vertices, std::span<const TriangleIndices> triangles,
                const TriangleBvhConfig& config = {});

    /// `triangle` is an index into the constructor's triangles.
    std::uint32_t leaf_of_triangle(std::uint32_t triangle) const { return leaf_of_triangle_[triangle]; }

    /// Labels are 0 .. leaf_count() - 1. No leaf is empty; without triangles there is none.
    std::uint32_t leaf_count() const { return std::uint32_t(leaf_begin_.size() - 1); }
    std::uint32_t depth() const { return depth_; }  ///< Of the deepest leaf; the root's is 0.

    std::span<const std::uint32_t> triangles_of_leaf(std::uint32_t label) const;  ///< Ascending.

private:
    std::vector<std::uint32_t> leaf_of_triangle_;
    std::vector<std::uint64_t> leaf_begin_{0};
    std::vector<std::uint32_t> leaf_triangles_;
    std::uint32_t depth_ = 0;
};

}  // namespace regather::spatial
