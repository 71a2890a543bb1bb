#include "spatial/rays/triangle_bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "spatial/rays/built_tree.h"
#include "trace/error.h"

namespace regather::spatial {

using trace::Bounds3;
using trace::Vec3;

namespace {

Vec3 centre(const Bounds3& box) {
    return (box.min + box.max) * 0.5f;
}

/// Puts the two children of each node into the order of the labels.
void arrange(BuiltNode& node) {
    if (node.child_count == 0) return;
    BuiltNode *&left = node.children[0], *&right = node.children[1];
    arrange(*left);
    arrange(*right);
    const Vec3 first = centre(left->bounds), second = centre(right->bounds);
    int axis = 0;
    for (int other = 1; other < 3; ++other)
        if (std::fabs(second[other] - first[other]) > std::fabs(second[axis] - first[axis])) axis = other;
    const bool second_leads =
        first[axis] != second[axis] ? second[axis] < first[axis] : right->lowest < left->lowest;
    if (second_leads) std::swap(left, right);
}

void check(const TriangleBvhConfig& config) {
    if (config.leaf_size < 1 || config.leaf_size > 32)
        throw trace::UsageError(
            fmt::format("TriangleBvhConfig: leaf_size is {}, expected 1 to 32", config.leaf_size));
    for (const auto& [name, cost] : {std::pair("traversal_cost", config.traversal_cost),
                                     std::pair("intersection_cost", config.intersection_cost)})
        if (!(cost > 0 && std::isfinite(cost)))
            throw trace::UsageError(
                fmt::format("TriangleBvhConfig: {} is {}, expected a number over 0", name, cost));
}

}  // namespace

TriangleBvh::TriangleBvh(std::span<const Vec3> vertices, std::span<const TriangleIndices> triangles,
                         const TriangleBvhConfig& config) {
    check(config);
    const std::vector<Bounds3> boxes = triangle_bounds(vertices, triangles);
    if (boxes.empty()) return;

    const BuiltTree tree(boxes, {.most_children = 2,
                                 .leaf_size = config.leaf_size,
                                 .traversal_cost = config.traversal_cost,
                                 .intersection_cost = config.intersection_cost});
    arrange(*tree.root());
    leaf_of_triangle_.resize(boxes.size());
    leaf_triangles_.reserve(boxes.size());
    std::vector<std::pair<const BuiltNode*, std::uint32_t>> pending{{tree.root(), 0}};
    while (!pending.empty()) {
        const auto [node, depth] = pending.back();
        pending.pop_back();
        if (node->child_count > 0) {
            pending.emplace_back(node->children[1], depth + 1);
            pending.emplace_back(node->children[0], depth + 1);
            continue;
        }
        for (const std::uint32_t t : node->numbers) leaf_of_triangle_[t] = leaf_count();
        leaf_triangles_.insert(leaf_triangles_.end(), node->numbers.begin(), node->numbers.end());
        leaf_begin_.push_back(leaf_triangles_.size());
        depth_ = std::max(depth_, depth);
    }
}

std::span<const std::uint32_t> TriangleBvh::triangles_of_leaf(std::uint32_t label) const {
    return std::span(leaf_triangles_)
        .subspan(leaf_begin_[label], leaf_begin_[label + 1] - leaf_begin_[label]);
}

}  // namespace regather::spatial
