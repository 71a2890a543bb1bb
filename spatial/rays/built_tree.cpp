#include "spatial/rays/built_tree.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace regather::spatial {
namespace {

static_assert(std::is_trivially_destructible_v<BuiltNode>);  // Embree frees the memory only.

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), alignof(BuiltNode))) BuiltNode;
}

void set_children(void* node, void** children, unsigned count, void*) {
    auto& parent = *static_cast<BuiltNode*>(node);
    parent.child_count = count;
    for (unsigned i = 0; i < count; ++i) parent.children[i] = static_cast<BuiltNode*>(children[i]);
}

// The boxes are made again from the leaves, so that they do not depend on how Embree merged them.
void ignore_bounds(void*, const RTCBounds**, unsigned, void*) {}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count,
                  void*) {
    auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), alignof(BuiltNode))) BuiltNode;
    auto* numbers = static_cast<std::uint32_t*>(
        rtcThreadLocalAlloc(allocator, count * sizeof(std::uint32_t), alignof(std::uint32_t)));
    for (std::size_t i = 0; i < count; ++i) numbers[i] = primitives[i].primID;
    leaf->numbers = {numbers, count};
    return leaf;
}

/// Keeps the first message: later ones follow from it.
void keep_message(void* kept, RTCError, const char* message) {
    auto& text = *static_cast<std::string*>(kept);
    if (text.empty()) text = message ? message : "no message";
}

/// Fills what Embree leaves open.
void complete(BuiltNode& node, std::span<const trace::Bounds3> boxes, std::uint32_t depth) {
    if (depth > BuiltTree::max_depth)
        throw std::runtime_error(
            fmt::format("Embree: rtcBuildBVH made a leaf deeper than {}", BuiltTree::max_depth));
    if (node.child_count == 0) {
        std::sort(node.numbers.begin(), node.numbers.end());
        node.lowest = node.numbers[0];
        for (const std::uint32_t n : node.numbers) node.bounds.include(boxes[n]);
        return;
    }
    node.lowest = 0xffffffffu;
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
        BuiltNode& child = *node.children[i];
        complete(child, boxes, depth + 1);
        node.bounds.include(child.bounds);
        node.lowest = std::min(node.lowest, child.lowest);
    }
}

/// Half of the surface.
double half_surface(const trace::Bounds3& box) {
    const double x = double(box.max.x) - double(box.min.x), y = double(box.max.y) - double(box.min.y),
                 z = double(box.max.z) - double(box.min.z);
    return x * y + y * z + z * x;
}

void widen(BuiltNode& node, std::uint32_t width) {
    const auto children = node.children.begin();
    while (node.child_count < width && node.child_count > 0) {
        auto taken = children + node.child_count;
        double largest = -1;
        for (auto child = children; child != children + node.child_count; ++child)
            if (const double surface = half_surface((*child)->bounds);
                (*child)->child_count > 0 && surface > largest) {
                largest = surface;
                taken = child;
            }
        if (taken == children + node.child_count) break;  // only leaves
        const BuiltNode& inner = **taken;
        std::move_backward(taken + 1, children + node.child_count, children + node.child_count + 1);
        *taken = inner.children[0];
        *(taken + 1) = inner.children[1];
        ++node.child_count;
    }
    for (std::uint32_t i = 0; i < node.child_count; ++i) widen(*node.children[i], width);
}

}  // namespace

struct BuiltTree::Embree {
    std::string message;
    RTCDevice device = rtcNewDevice(nullptr);
    RTCBVH bvh = nullptr;

    Embree() {
        // No `threads=`: with TBB that would limit the whole process. The arena below limits the build alone.
        if (!device)
            throw std::runtime_error(
                fmt::format("Embree: cannot make a device, error {}", int(rtcGetDeviceError(nullptr))));
        rtcSetDeviceErrorFunction(device, keep_message, &message);
        bvh = rtcNewBVH(device);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
    ~Embree() {
        rtcReleaseBVH(bvh);
        rtcReleaseDevice(device);
    }
};

BuiltTree::BuiltTree(std::span<const trace::Bounds3> boxes, const BuildConfig& config) {
    if (boxes.empty()) return;
    embree_ = std::make_unique<Embree>();
    std::vector<RTCBuildPrimitive> primitives(boxes.size());
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        const auto& [min, max] = boxes[b];
        primitives[b] = {min.x, min.y, min.z, 0, max.x, max.y, max.z, std::uint32_t(b)};
    }
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = config.most_children;
    arguments.maxDepth = max_depth;
    arguments.sahBlockSize = config.block_size;
    arguments.maxLeafSize = config.leaf_size;
    arguments.traversalCost = config.traversal_cost;
    arguments.intersectionCost = config.intersection_cost;
    arguments.bvh = embree_->bvh;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = ignore_bounds;
    arguments.createLeaf = create_leaf;
    // One thread: Embree promises nothing of the order in which its parallel partition leaves the boxes.
    tbb::task_arena(1).execute([&] { root_ = static_cast<BuiltNode*>(rtcBuildBVH(&arguments)); });
    if (!root_ || !embree_->message.empty())
        throw std::runtime_error(fmt::format("Embree: rtcBuildBVH failed: {}", embree_->message));
    complete(*root_, boxes, 0);
}

BuiltTree::~BuiltTree() = default;

void BuiltTree::collapse(std::uint32_t width) {
    if (root_) widen(*root_, width);
}

}  // namespace regather::spatial
