// spatial/rays/ray_bvh.h -- the hierarchy that rays are cast through (spatial/rays/cast.h): nodes of up to
// eight children, whose boxes lie side by side for one vector operation each, and leaves of up to eight
// triangles, likewise. Built from BuiltTree (spatial/rays/built_tree.h). Lengths in scene units.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "spatial/rays/triangle.h"
#include "trace/bounds.h"
#include "trace/vec.h"

namespace regather::spatial {

class RayBvh {
public:
    static constexpr std::uint32_t width = 8;
    /// A child is a node, or with this bit a block of triangles.
    static constexpr std::uint32_t leaf_bit = 0x80000000u;

    struct alignas(64) Node {
        float planes[3][2][width];  ///< By axis: the lower and the upper plane of each child's box.
        std::uint32_t
            children[width];  ///< Where there is none, the box is empty (lower plane above upper one).
    };
    /// The triangles of a leaf, with the smaller number first.
    struct alignas(64) Block {
        float corners[3][3][width];      ///< By axis and corner.
        std::uint32_t triangles[width];  ///< Into the constructor's triangles.
        std::uint32_t count;
    };

    /// Of a tree that is not the renderer's.
    struct Shape {
        std::uint32_t node_width = width;  ///< Children of a node at most: 2 to 8.
        std::uint32_t leaf_triangles = 4;  ///< At most: 1 to 8.
        bool quantised = false;  ///< Planes of children as 8 bits on a grid over the node's box, outwards.
    };

    RayBvh() = default;
    /// Triangles without any area (across() is 0) are left out. Throws trace::DataError as
    /// triangle_bounds() does, and std::runtime_error with Embree's message when Embree fails.
    RayBvh(std::span<const trace::Vec3> vertices, std::span<const TriangleIndices> triangles);
    /// Nodes of another width, collapsed from one binary tree (BuiltTree::collapse()): all widths have the
    /// same leaves. Quantised planes lie at the node's lower corner + n x 2^e, n from 0 to 255, 2^e the least
    /// power of two above 1/255 of the node's extent on the axis (Ylitie, Karras, Laine: "Efficient
    /// Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 2017, section 3): boxes are larger,
    /// and rays visit more. Throws as above, and trace::UsageError for a shape out of range.
    RayBvh(std::span<const trace::Vec3> vertices, std::span<const TriangleIndices> triangles,
           const Shape& shape);

    const std::vector<Node>& nodes() const { return nodes_; }     ///< The root first; pre-order.
    const std::vector<Block>& blocks() const { return blocks_; }  ///< In the order of a walk in pre-order.
    const trace::Bounds3& bounds() const { return bounds_; }      ///< Of all triangles with an area.
    bool empty() const { return blocks_.empty(); }
    std::uint32_t root() const { return nodes_.empty() ? leaf_bit : 0; }  ///< A child; only when not empty().

private:
    void build(std::span<const trace::Vec3> vertices, std::span<const TriangleIndices> triangles,
               const Shape* shape);

    std::vector<Node> nodes_;
    std::vector<Block> blocks_;
    trace::Bounds3 bounds_;
};

}  // namespace regather::spatial
