#include "spatial/rays/ray_bvh.h"

#include <array>
#include <limits>

#include "spatial/rays/built_tree.h"

namespace regather::spatial {

using trace::Bounds3;
using trace::Vec3;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

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

}  // namespace

RayBvh::RayBvh(std::span<const Vec3> vertices, std::span<const TriangleIndices> triangles) {
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
    const BuiltTree tree(boxes, {.most_children = width, .leaf_size = width, .block_size = width});
    if (tree.root()) Packer(vertices, triangles, number_of, nodes_, blocks_).pack(*tree.root());
}

}  // namespace regather::spatial
