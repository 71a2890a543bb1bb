#include "spatial/rays/triangle_kd.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "trace/error.h"

namespace regather::spatial {

using trace::Bounds3;
using trace::Vec3;

namespace {

constexpr std::uint32_t deepest = 64;

/// Where a triangle's box begins or ends on an axis; `flat` does both at once. In the order of a sweep.
enum class EventKind : std::uint32_t { end, flat, start };

struct Event {
    float position;
    EventKind kind;
    std::uint32_t triangle;
    friend bool operator<(const Event& a, const Event& b) {
        return std::tie(a.position, a.kind, a.triangle) < std::tie(b.position, b.kind, b.triangle);
    }
};

/// The events of a node's triangles, sorted, on each axis. They are not clipped to the node: those outside it
/// only count triangles in and out.
using EventLists = std::array<std::vector<Event>, 3>;

struct Split {
    int axis;
    float position;
};

double half_area(const Bounds3& box) {
    const double x = double(box.max.x) - double(box.min.x), y = double(box.max.y) - double(box.min.y),
                 z = double(box.max.z) - double(box.min.z);
    return x * y + y * z + z * x;
}

std::pair<Bounds3, Bounds3> cut(const Bounds3& box, Split split) {
    std::pair<Bounds3, Bounds3> halves{box, box};
    halves.first.max[split.axis] = split.position;
    halves.second.min[split.axis] = split.position;
    return halves;
}

void check(const TriangleKdConfig& config) {
    const auto refuse = [](const char* field, float found, const char* expected) {
        throw trace::UsageError(
            fmt::format("TriangleKdConfig: {} is {}, expected {}", field, found, expected));
    };
    if (config.max_depth > deepest) refuse("max_depth", float(config.max_depth), "at most 64");
    if (!(config.traversal_cost > 0 && std::isfinite(config.traversal_cost)))
        refuse("traversal_cost", config.traversal_cost, "a number over 0");
    if (!(config.intersection_cost > 0 && std::isfinite(config.intersection_cost)))
        refuse("intersection_cost", config.intersection_cost, "a number over 0");
    if (!(config.empty_space_factor > 0 && config.empty_space_factor <= 1))
        refuse("empty_space_factor", config.empty_space_factor, "a number over 0, at most 1");
}

std::uint32_t automatic_depth(std::size_t triangles) {
    const auto log2_floor = std::uint32_t(std::bit_width(triangles | 1) - 1);
    return std::min(deepest, 8 + log2_floor * 13 / 10);
}

}  // namespace

class TriangleKdBuilder {
public:
    TriangleKdBuilder(TriangleKd& tree, std::span<const Bounds3> boxes, const TriangleKdConfig& config)
        : tree_(tree),
          boxes_(boxes),
          config_(config),
          max_depth_(config.max_depth > 0 ? config.max_depth : automatic_depth(boxes.size())),
          sides_(boxes.size()) {}

    void build() {
        EventLists events;
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<Event>& list = events[std::size_t(axis)];
            list.reserve(2 * boxes_.size());
            for (std::uint32_t t = 0; t < boxes_.size(); ++t) {
                const float low = boxes_[t].min[axis], high = boxes_[t].max[axis];
                if (low == high) {
                    list.push_back({low, EventKind::flat, t});
                } else {
                    list.push_back({low, EventKind::start, t});
                    list.push_back({high, EventKind::end, t});
                }
            }
            std::sort(list.begin(), list.end());
        }
        build_node(tree_.bounds_, std::move(events), boxes_.size(), 0);
    }

private:
    enum Side : std::uint8_t { lower = 1, upper = 2 };

    void build_node(const Bounds3& box, EventLists events, std::size_t count, std::uint32_t depth) {
        std::optional<Split> split;
        if (count > config_.leaf_size && depth < max_depth_) split = best_split(box, events, count);
        if (!split) return add_leaf(events[0], depth);

        const std::size_t node = tree_.nodes_.size();
        tree_.nodes_.push_back({split->position, 0, std::uint32_t(split->axis)});
        ++tree_.stats_.inner_nodes;

        const auto [lower_count, upper_count] = classify(events[0], *split);
        EventLists lower_events = take(events, lower, lower_count),
                   upper_events = take(events, upper, upper_count);
        events = {};
        const auto [lower_box, upper_box] = cut(box, *split);
        build_node(lower_box, std::move(lower_events), lower_count, depth + 1);
        tree_.nodes_[node].next = std::uint32_t(tree_.nodes_.size());
        build_node(upper_box, std::move(upper_events), upper_count, depth + 1);
    }

    /// The cheapest plane strictly inside the box, if it is cheaper than a leaf. Equal costs: x before y
    /// before z, then the lower plane.
    std::optional<Split> best_split(const Bounds3& box, const EventLists& events, std::size_t count) const {
        const double whole = half_area(box);
        if (!(whole > 0)) return {};  // All on one line: no area to weigh.
        double best_cost = double(config_.intersection_cost) * double(count);
        std::optional<Split> best;
        for (int axis = 0; axis < 3; ++axis) {
            const std::vector<Event>& list = events[std::size_t(axis)];
            std::size_t below = 0, above = count;
            for (auto event = list.begin(); event != list.end() && event->position < box.max[axis];) {
                const float position = event->position;
                std::array<std::size_t, 3> met{};
                for (; event != list.end() && event->position == position; ++event)
                    ++met[std::size_t(event->kind)];
                const std::size_t flat = met[std::size_t(EventKind::flat)];
                above -= met[std::size_t(EventKind::end)] + flat;
                if (position > box.min[axis]) {
                    const double cost = split_cost(box, whole, {axis, position}, below + flat, above);
                    if (cost < best_cost) {
                        best_cost = cost;
                        best = {axis, position};
                    }
                }
                below += met[std::size_t(EventKind::start)] + flat;
            }
        }
        return best;
    }

    double split_cost(const Bounds3& box, double whole, Split split, std::size_t below,
                      std::size_t above) const {
        const auto [lower_box, upper_box] = cut(box, split);
        const double tests =
            (half_area(lower_box) * double(below) + half_area(upper_box) * double(above)) / whole;
        const double cost = double(config_.traversal_cost) + double(config_.intersection_cost) * tests;
        return below == 0 || above == 0 ? double(config_.empty_space_factor) * cost : cost;
    }

    /// Sets sides_ of the node's triangles; returns how many lie below and above the plane.
    std::pair<std::size_t, std::size_t> classify(std::span<const Event> events, Split split) {
        std::pair<std::size_t, std::size_t> counts{0, 0};
        for (const Event& event : events) {
            if (event.kind == EventKind::end) continue;
            const float low = boxes_[event.triangle].min[split.axis],
                        high = boxes_[event.triangle].max[split.axis];
            const bool is_lower =
                low < split.position || high <= split.position;  // Flat in the plane: lower.
            const bool is_upper = high > split.position;
            sides_[event.triangle] = std::uint8_t((is_lower ? lower : 0) | (is_upper ? upper : 0));
            counts.first += is_lower;
            counts.second += is_upper;
        }
        return counts;
    }

    EventLists take(const EventLists& events, Side side, std::size_t count) const {
        EventLists taken;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            taken[axis].reserve(2 * count);
            for (const Event& event : events[axis])
                if (sides_[event.triangle] & side) taken[axis].push_back(event);
        }
        return taken;
    }

    void add_leaf(std::span<const Event> events, std::uint32_t depth) {
        TriangleKdStats& stats = tree_.stats_;
        std::vector<std::uint32_t>& listed = tree_.leaf_triangles_;
        for (const Event& event : events)
            if (event.kind != EventKind::end) listed.push_back(event.triangle);
        const std::uint64_t begin = tree_.leaf_begin_.back(), end = listed.size();
        std::sort(listed.begin() + std::ptrdiff_t(begin), listed.end());
        tree_.leaf_begin_.push_back(end);
        tree_.nodes_.push_back({0, stats.leaves, TriangleKd::leaf_axis});
        ++stats.leaves;
        stats.empty_leaves += begin == end;
        stats.references += end - begin;
        stats.depth = std::max(stats.depth, depth);
    }

    TriangleKd& tree_;
    std::span<const Bounds3> boxes_;
    const TriangleKdConfig& config_;
    std::uint32_t max_depth_;
    std::vector<std::uint8_t> sides_;  // By triangle: where the node that is being split puts it.
};

TriangleKd::TriangleKd(std::span<const Vec3> vertices, std::span<const TriangleIndices> triangles,
                       const TriangleKdConfig& config) {
    check(config);
    const std::vector<Bounds3> boxes = triangle_bounds(vertices, triangles);
    for (const Bounds3& box : boxes) bounds_.include(box);
    TriangleKdBuilder(*this, boxes, config).build();
}

std::uint32_t TriangleKd::leaf_of(Vec3 point) const {
    if (std::isnan(point.x) || std::isnan(point.y) || std::isnan(point.z)) return 0;
    std::uint32_t node = 0;
    while (nodes_[node].axis != leaf_axis)
        node = point[int(nodes_[node].axis)] <= nodes_[node].split ? node + 1 : nodes_[node].next;
    return nodes_[node].next;
}

std::vector<Bounds3> TriangleKd::leaf_bounds() const {
    std::vector<Bounds3> found;
    std::vector<Bounds3> pending{bounds_};  // Nodes stand depth-first, so a stack of boxes runs beside them.
    for (const Node& node : nodes_) {
        const Bounds3 box = pending.back();
        pending.pop_back();
        if (node.axis == leaf_axis) {
            found.push_back(box);
        } else {
            const auto [lower_box, upper_box] = cut(box, {int(node.axis), node.split});
            pending.push_back(upper_box);
            pending.push_back(lower_box);
        }
    }
    return found;
}

std::span<const std::uint32_t> TriangleKd::triangles_of_leaf(std::uint32_t label) const {
    return std::span(leaf_triangles_)
        .subspan(leaf_begin_[label], leaf_begin_[label + 1] - leaf_begin_[label]);
}

}  // namespace regather::spatial
