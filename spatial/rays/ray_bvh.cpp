#include "spatial/rays/ray_bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "spatial/rays/built_tree.h"
#include "trace/range.h"

namespace regather::spatial {

using trace::Bounds3;
using trace::Vec3;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// The float that is x, or the next one on the way to `direction`.
float rounded_towards(double x, float direction) {
    const auto rounded = static_cast<float>(x);
    const bool beyond = direction > 0 ? double{rounded} < x : double{rounded} > x;
    return beyond ? std::nextafter(rounded, direction) : rounded;
}

/// Makes nodes and blocks of a built tree.
class Packer {
public:
    Packer(std::span<const Vec3> vertices, std::span<const TriangleIndices> triangles,
           std::span<const std::uint32_t> number_of, std::vector<RayBvh::Node>& nodes,
           std::vector<RayBvh::Block>& blocks)
        : vertices_(vertices), triangles_(triangles), number_of_(number_of), nodes_(nodes), blocks_(blocks) {}

    /// The child that stands for `built`.
    std::uint32_t pack(const BuiltNode& built) {
        return built.child_count == 0 ? pack_block(built) : pack_node(built);
    }

private:
    std::uint32_t pack_block(const BuiltNode& built) {
        RayBvh::Block block{};
        block.count = std::uint32_t(built.numbers.size());
        for (std::uint32_t lane = 0; lane < block.count; ++lane) {
            const std::uint32_t t = number_of_[built.numbers[lane]];
            block.triangles[lane] = t;
            for (int corner = 0; corner < 3; ++corner)
                for (int axis = 0; axis < 3; ++axis)
                    block.corners[axis][corner][lane] = vertices_[triangles_[t][corner]][axis];
        }
        blocks_.push_back(block);
        return std::uint32_t(blocks_.size() - 1) | RayBvh::leaf_bit;
    }
    std::uint32_t pack_node(const BuiltNode& built) {
        const std::size_t at = nodes_.size();
        nodes_.emplace_back();
        for (std::uint32_t i = 0; i < RayBvh::width; ++i) {
            const bool there = i < built.child_count;
            for (int axis = 0; axis < 3; ++axis) {
                nodes_[at].planes[axis][0][i] = there ? built.children[i]->bounds.min[axis] : infinity;
                nodes_[at].planes[axis][1][i] = there ? built.children[i]->bounds.max[axis] : -infinity;
            }
            const std::uint32_t child = there ? pack(*built.children[i]) : 0;
            nodes_[at].children[i] = child;
        }
        return std::uint32_t(at);
    }

    std::span<const Vec3> vertices_;
    std::span<const TriangleIndices> triangles_;
    std::span<const std::uint32_t> number_of_;
    std::vector<RayBvh::Node>& nodes_;
    std::vector<RayBvh::Block>& blocks_;
};

/// Moves the planes of a node's children on one axis outwards onto its grid. Children that are not there stay
/// empty. Every grid plane is a double exactly; the float next to it may lie a step further out.
void quantise(float* lower, float* upper) {
    double from = infinity, to = -infinity;
    for (std::uint32_t i = 0; i < RayBvh::width; ++i) {
        if (lower[i] > upper[i]) continue;
        from = std::min(from, double{lower[i]});
        to = std::max(to, double{upper[i]});
    }
    if (!(to > from)) return;  // flat: the planes are the corner itself
    int exponent = 0;
    std::frexp((to - from) / 255, &exponent);  // below 2^exponent
    const double step = std::ldexp(1.0, exponent);
    for (std::uint32_t i = 0; i < RayBvh::width; ++i) {
        if (lower[i] > upper[i]) continue;
        const double below = from + std::floor((lower[i] - from) / step) * step,
                     above = from + std::ceil((upper[i] - from) / step) * step;
        lower[i] = rounded_towards(below, -infinity);
        upper[i] = rounded_towards(above, infinity);
    }
}

}  // namespace

RayBvh::RayBvh(std::span<const Vec3> vertices, std::span<const TriangleIndices> triangles) {
    build(vertices, triangles, nullptr);
}

RayBvh::RayBvh(std::span<const Vec3> vertices, std::span<const TriangleIndices> triangles,
               const Shape& shape) {
    trace::require_range("RayBvh", "node_width", shape.node_width, 2, width);
    trace::require_range("RayBvh", "leaf_triangles", shape.leaf_triangles, 1, width);
    build(vertices, triangles, &shape);
    if (!shape.quantised) return;
    // A node's own box is the union of its children's, as they were before.
    for (Node& node : nodes_)
        for (auto& planes : node.planes) quantise(planes[0], planes[1]);
}

void RayBvh::build(std::span<const Vec3> vertices, std::span<const TriangleIndices> triangles,
                   const Shape* shape) {
    const std::vector<Bounds3> all = triangle_bounds(vertices, triangles);
    std::vector<Bounds3> boxes;
    std::vector<std::uint32_t> number_of;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        if (across(vertices[a], vertices[b], vertices[c]) == std::array{0.0, 0.0, 0.0}) continue;
        boxes.push_back(all[t]);
        number_of.push_back(t);
        bounds_.include(all[t]);
    }
    BuiltTree tree(boxes, shape
                              ? BuildConfig{.leaf_size = shape->leaf_triangles}
                              : BuildConfig{.most_children = width, .leaf_size = width, .block_size = width});
    if (shape) tree.collapse(shape->node_width);
    if (tree.root()) Packer(vertices, triangles, number_of, nodes_, blocks_).pack(*tree.root());
}

}  // namespace regather::spatial
