#include "spatial/triangle_bvh.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "trace/error.h"

namespace regather::spatial {

using trace::Bounds3;
using trace::Vec3;

namespace {

// Deeper than Embree's default of 32, which small triangles in a vast scene reach.
constexpr unsigned max_depth = 64;

/// What Embree's callbacks make, in memory that belongs to the RTCBVH.
struct BuiltNode {
    BuiltNode* children[2] = {nullptr, nullptr};  // Both null in a leaf.
    std::uint32_t* triangles = nullptr;
    std::size_t triangle_count = 0;
    Bounds3 bounds;
    std::uint32_t lowest_triangle = 0;
};
static_assert(std::is_trivially_destructible_v<BuiltNode>);  // Embree frees the memory only.

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), alignof(BuiltNode))) BuiltNode;
}

void set_children(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i)
        static_cast<BuiltNode*>(node)->children[i] = static_cast<BuiltNode*>(children[i]);
}

// The boxes are made again from the triangles, so that they do not depend on how Embree merged them.
void ignore_bounds(void*, const RTCBounds**, unsigned, void*) {}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count,
                  void*) {
    auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), alignof(BuiltNode))) BuiltNode;
    leaf->triangles = static_cast<std::uint32_t*>(
        rtcThreadLocalAlloc(allocator, count * sizeof(std::uint32_t), alignof(std::uint32_t)));
    leaf->triangle_count = count;
    for (std::size_t i = 0; i < count; ++i) leaf->triangles[i] = primitives[i].primID;
    return leaf;
}

/// Keeps the first message: later ones follow from it.
void keep_message(void* kept, RTCError, const char* message) {
    auto& text = *static_cast<std::string*>(kept);
    if (text.empty()) text = message ? message : "no message";
}

Vec3 centre(const Bounds3& box) {
    return (box.min + box.max) * 0.5f;
}

/// Fills bounds and lowest_triangle, and sorts the children and the triangles of leaves.
void arrange(BuiltNode& node, std::span<const Bounds3> boxes) {
    if (!node.children[0]) {
        std::sort(node.triangles, node.triangles + node.triangle_count);
        node.lowest_triangle = node.triangles[0];
        for (std::size_t i = 0; i < node.triangle_count; ++i) node.bounds.include(boxes[node.triangles[i]]);
        return;
    }
    for (BuiltNode* child : node.children) {
        arrange(*child, boxes);
        node.bounds.include(child->bounds);
    }
    const Vec3 first = centre(node.children[0]->bounds), second = centre(node.children[1]->bounds);
    int axis = 0;
    for (int other = 1; other < 3; ++other)
        if (std::fabs(second[other] - first[other]) > std::fabs(second[axis] - first[axis])) axis = other;
    const bool second_leads = first[axis] != second[axis]
                                  ? second[axis] < first[axis]
                                  : node.children[1]->lowest_triangle < node.children[0]->lowest_triangle;
    if (second_leads) std::swap(node.children[0], node.children[1]);
    node.lowest_triangle = std::min(node.children[0]->lowest_triangle, node.children[1]->lowest_triangle);
}

void check(const TriangleBvhConfig& config) {
    if (config.leaf_size < 1 || config.leaf_size > RTC_BUILD_MAX_PRIMITIVES_PER_LEAF)
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

    std::vector<RTCBuildPrimitive> primitives(boxes.size());
    for (std::size_t t = 0; t < boxes.size(); ++t) {
        const auto& [min, max] = boxes[t];
        primitives[t] = {min.x, min.y, min.z, 0, max.x, max.y, max.z, std::uint32_t(t)};
    }

    // No `threads=` here: with TBB that would limit the whole process. The arena below limits this build
    // alone.
    const std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device(rtcNewDevice(nullptr),
                                                                           rtcReleaseDevice);
    if (!device)
        throw std::runtime_error(
            fmt::format("Embree: cannot make a device, error {}", int(rtcGetDeviceError(nullptr))));
    std::string message;
    rtcSetDeviceErrorFunction(device.get(), keep_message, &message);
    const std::unique_ptr<RTCBVHTy, decltype(&rtcReleaseBVH)> bvh(rtcNewBVH(device.get()), rtcReleaseBVH);

    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = max_depth;
    arguments.maxLeafSize = config.leaf_size;
    arguments.traversalCost = config.traversal_cost;
    arguments.intersectionCost = config.intersection_cost;
    arguments.bvh = bvh.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = ignore_bounds;
    arguments.createLeaf = create_leaf;
    BuiltNode* root = nullptr;
    // One thread: Embree promises nothing of the order in which its parallel partition leaves the triangles.
    tbb::task_arena(1).execute([&] { root = static_cast<BuiltNode*>(rtcBuildBVH(&arguments)); });
    if (!root || !message.empty())
        throw std::runtime_error(fmt::format("Embree: rtcBuildBVH failed: {}", message));

    arrange(*root, boxes);
    leaf_of_triangle_.resize(boxes.size());
    leaf_triangles_.reserve(boxes.size());
    std::vector<std::pair<const BuiltNode*, std::uint32_t>> pending{{root, 0}};
    while (!pending.empty()) {
        const auto [node, depth] = pending.back();
        pending.pop_back();
        if (node->children[0]) {
            pending.emplace_back(node->children[1], depth + 1);
            pending.emplace_back(node->children[0], depth + 1);
            continue;
        }
        const std::span<const std::uint32_t> listed(node->triangles, node->triangle_count);
        for (const std::uint32_t t : listed) leaf_of_triangle_[t] = leaf_count();
        leaf_triangles_.insert(leaf_triangles_.end(), listed.begin(), listed.end());
        leaf_bounds_.push_back(node->bounds);
        leaf_begin_.push_back(leaf_triangles_.size());
        depth_ = std::max(depth_, depth);
    }
}

std::span<const std::uint32_t> TriangleBvh::triangles_of_leaf(std::uint32_t label) const {
    return std::span(leaf_triangles_)
        .subspan(leaf_begin_[label], leaf_begin_[label + 1] - leaf_begin_[label]);
}

}  // namespace regather::spatial
