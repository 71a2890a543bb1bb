#include "spatial/rays/ray_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>

#include "spatial/rays/ray_walk.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

/// The most children that wait at once on any way down: at each node, all but the one gone to.
std::uint32_t greatest_height(const RayTree::Shape& shape) {
    const std::size_t inner = shape.children.size() / shape.width;
    std::vector<std::uint32_t> height(inner);  // above the node
    std::uint32_t greatest = 0;
    for (std::size_t i = 0; i < inner; ++i) {
        const auto row = std::span(shape.children).subspan(i * shape.width, shape.width);
        const auto count = static_cast<std::uint32_t>(std::count_if(row.begin(), row.end(), std::identity()));
        const std::uint32_t below = height[i] + std::max(count, 1u) - 1;
        greatest = std::max(greatest, below);
        for (const std::uint32_t child : row)
            if (child != 0 && child < inner) height[child] = below;
    }
    return greatest;
}

std::vector<ElementRange> ranges_of(const RayTree::Shape& shape, const RayTree::Stack& stack) {
    std::vector<ElementRange> ranges;
    const auto inner = static_cast<std::uint32_t>(shape.children.size() / shape.width),
               leaves = static_cast<std::uint32_t>(shape.leaf_begin.size() - 1);
    if (inner > 0) ranges.push_back({trace::Region::nodes, 0, inner});
    if (leaves > 0) ranges.push_back({trace::Region::triangles, inner, leaves});
    if (stack.on_chip)
        if (const std::uint32_t height = greatest_height(shape); height > *stack.on_chip)
            ranges.push_back({trace::Region::stack, inner + leaves, height - *stack.on_chip});
    return ranges;
}

}  // namespace

RayTree::RayTree(std::string name, Shape shape, Stack stack)
    : Structure(ranges_of(shape, stack)),
      name_(std::move(name)),
      shape_(std::move(shape)),
      stack_(stack),
      level_(inner_nodes() + leaves()),
      slot_(level_.size()) {
    // A child's number is above its parent's, or it is a leaf: one pass from the root.
    for (std::uint32_t c = 0; c < shape_.children.size(); ++c) {
        const std::uint32_t child = shape_.children[c];
        if (child == 0) continue;
        level_[child] = level_[c / shape_.width] + 1;
        slot_[child] = static_cast<std::uint8_t>(c % shape_.width);
        deepest_ = std::max(deepest_, level_[child]);
    }
    if (deepest_ > most_levels)
        throw trace::DataError(
            fmt::format("{}: found a leaf at level {}, expected at most {}", name_, deepest_, most_levels));
}

std::unique_ptr<WalkDecoder> RayTree::decoder() const {
    return ray_walk_decoder(*this);
}

void RayTree::append_children(std::uint32_t element, std::vector<std::uint32_t>& to) const {
    if (element >= inner_nodes()) return;
    const auto row = std::span(shape_.children).subspan(std::size_t{element} * shape_.width, shape_.width);
    const std::size_t before = to.size();
    std::copy_if(row.begin(), row.end(), std::back_inserter(to), std::identity());
    std::sort(to.begin() + static_cast<std::ptrdiff_t>(before), to.end());
}

std::vector<std::uint32_t> RayTree::roots() const {
    std::vector<std::uint32_t> roots;
    if (!level_.empty()) roots.push_back(0);
    const ElementRange places = range_of(trace::Region::stack);
    for (std::uint32_t p = 0; p < places.count; ++p) roots.push_back(places.first + p);
    return roots;
}

std::uint32_t RayTree::records(std::uint32_t element) const {
    if (element < inner_nodes() || element >= level_.size()) return 1;
    const std::uint32_t leaf = element - inner_nodes();
    return shape_.leaf_begin[leaf + 1] - shape_.leaf_begin[leaf];
}

bool RayTree::same_as(const Structure& other) const {
    const auto* const tree = dynamic_cast<const RayTree*>(&other);
    return tree && Structure::same_as(other) && shape_ == tree->shape_ &&
           stack_.any_hit == tree->stack_.any_hit;
}

std::uint32_t RayTree::node_bytes() const {
    if (!shape_.quantised) return shape_.width * 32;
    return shape_.width == 8 ? 80 : shape_.width * 16;
}

RayTree::Shape shape_of(const RayBvh& bvh, std::uint32_t width, bool quantised) {
    RayTree::Shape shape{.width = width, .quantised = quantised};
    const auto inner = static_cast<std::uint32_t>(bvh.nodes().size());
    for (const RayBvh::Node& node : bvh.nodes())
        for (std::uint32_t slot = 0; slot < width; ++slot) {
            const std::uint32_t child = node.children[slot];
            shape.children.push_back(child & RayBvh::leaf_bit ? inner + (child & ~RayBvh::leaf_bit) : child);
        }
    for (const RayBvh::Block& block : bvh.blocks())
        shape.leaf_begin.push_back(shape.leaf_begin.back() + block.count);
    return shape;
}

}  // namespace regather::spatial
