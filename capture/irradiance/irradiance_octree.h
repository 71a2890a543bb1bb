// capture/irradiance/irradiance_octree.h -- records of irradiance by place and reach (Ward, Rubinstein &
// Clear, "A Ray Tracing Solution for Diffuse Interreflection", SIGGRAPH 1988): each in one cell, the smallest
// that is twice as wide as it reaches, so that a search looks at few cells of each size.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "capture/irradiance/irradiance_record.h"
#include "spatial/listed.h"
#include "trace/bounds.h"

namespace regather::capture {

/// Hears of no touch.
struct UntoldTouches {
    void node(std::uint32_t) const {}
    void record(std::uint32_t) const {}
};

/// Nodes are numbered as they come, the root 0, records as they are inserted: the numbers stay.
class IrradianceOctree {
public:
    static constexpr std::uint32_t most_levels = 24;    ///< Below it a cell holds what there is.
    static constexpr std::uint32_t node_bytes = 40;     ///< Eight children, its first and its last record.
    static constexpr std::uint32_t record_bytes = 132;  ///< The record, and which comes next in its cell.

    /// Records serve by errors below `tolerance` (Ward's a, above 0) or less. `box` says where they lie; one
    /// outside of it stands in the root, which every search looks at.
    IrradianceOctree(const trace::Bounds3& box, double tolerance, bool clamps_neighbours);

    /// With neighbours clamped its R becomes at most each other record's and the distance to it, and then
    /// each other record's at most its own and the distance (Krivanek et al. 2006). The listener hears what
    /// is read or written. Not while others search. UsageError beyond 2^30 records.
    template <class Listener = UntoldTouches>
    std::uint32_t insert(IrradianceRecord record, Listener&& listener = {}) {
        if (clamps_neighbours_) clamp(record, listener);
        const std::uint32_t node = cell_of(record, listener), number = append(record, node);
        listener.record(number);
        return number;
    }

    /// Calls `use` with the number of each record that serves the point by an error below `tolerance`, at
    /// most the octree's. Any number of threads.
    template <class Use, class Listener = UntoldTouches>
    void search(const IrradiancePoint& point, double tolerance, Use&& use, Listener&& listener = {}) const {
        const auto enter = [&](const auto& self, std::uint32_t node) -> void {
            listener.node(node);
            for (std::uint32_t r = nodes_[node].first; r != none; r = records_[r].next) {
                listener.record(r);
                if (serves(records_[r].record, point, tolerance)) use(r);
            }
            for (const std::uint32_t child : nodes_[node].child)
                // Reaches below are at most half a cell's width, which is cell.half.
                if (child != none && distance(cells_[child], point.position) <= cells_[child].half)
                    self(self, child);
        };
        enter(enter, 0);
    }

    /// What the records that serve the point say of it; nothing where none does.
    template <class Listener = UntoldTouches>
    std::optional<Vec3> irradiance(const IrradiancePoint& point, double tolerance,
                                   Listener&& listener = {}) const {
        IrradianceMean mean(point);
        search(
            point, tolerance, [&](std::uint32_t r) { mean.add(records_[r].record); }, listener);
        return mean.empty() ? std::nullopt : std::optional(mean.irradiance());
    }

    double tolerance() const { return tolerance_; }
    std::uint32_t nodes() const { return static_cast<std::uint32_t>(nodes_.size()); }
    std::uint32_t size() const { return static_cast<std::uint32_t>(records_.size()); }
    const IrradianceRecord& record(std::uint32_t number) const { return records_[number].record; }
    /// Of nodes and records.
    std::uint64_t bytes() const {
        return std::uint64_t{node_bytes} * nodes() + std::uint64_t{record_bytes} * size();
    }

    /// As a replay knows what is there: elements of Region::nodes, then of Region::irradiance, by number.
    std::shared_ptr<const spatial::Listed> share_structure(std::string name = "irradiance-octree") const;

private:
    static constexpr std::uint32_t none = ~0u;
    struct Node {
        std::array<std::uint32_t, 8> child;
        std::uint32_t first, last;
    };
    struct Held {
        IrradianceRecord record;
        std::uint32_t next;
    };
    static_assert(sizeof(Node) == node_bytes && sizeof(Held) == record_bytes);
    struct Cell {  // follows from the path to it: no memory of a search
        Vec3d middle;
        double half = 0;  // of its width
        std::uint32_t level = 0;
    };

    /// To the cell's cube, along the axis where it is longest.
    static double distance(const Cell& cell, Vec3 point) {
        double most = 0;
        for (int axis = 0; axis < 3; ++axis)
            most =
                std::max(most, std::fabs(static_cast<double>(point[axis]) - cell.middle[axis]) - cell.half);
        return most;
    }
    /// The child of the record's octant, where there is one for it.
    bool descends(const IrradianceRecord& record, std::uint32_t node, std::uint32_t& octant) const;
    std::uint32_t append(const IrradianceRecord& record, std::uint32_t node);
    std::uint32_t add_child(std::uint32_t node, std::uint32_t octant);

    template <class Listener>
    std::uint32_t cell_of(const IrradianceRecord& record, Listener& listener) {
        std::uint32_t node = 0, octant = 0;
        listener.node(node);
        while (descends(record, node, octant)) {
            const std::uint32_t child = nodes_[node].child[octant];
            node = child != none ? child : add_child(node, octant);
            listener.node(node);
        }
        return node;
    }

    template <class Listener>
    void clamp(IrradianceRecord& record, Listener& listener) {
        // Who might be nearer than one of both R's.
        std::vector<std::pair<std::uint32_t, double>> near;
        const auto enter = [&](const auto& self, std::uint32_t node) -> void {
            listener.node(node);
            for (std::uint32_t r = nodes_[node].first; r != none; r = records_[r].next) {
                listener.record(r);
                near.emplace_back(r,
                                  trace::length(Vec3d(record.position) - Vec3d(records_[r].record.position)));
            }
            for (const std::uint32_t child : nodes_[node].child)
                if (child != none &&
                    distance(cells_[child], record.position) <=
                        std::max(static_cast<double>(record.longer), cells_[child].half / tolerance_))
                    self(self, child);
        };
        enter(enter, 0);
        for (const auto& [r, distance] : near)
            shrink(record, static_cast<double>(records_[r].record.longer) + distance);
        for (const auto& [r, distance] : near)
            shrink(records_[r].record, static_cast<double>(record.longer) + distance);
    }
    static void shrink(IrradianceRecord& record, double most) {
        record.longer = std::fmin(record.longer, static_cast<float>(std::fmin(most, 3e38)));
        record.shorter = std::fmin(record.shorter, record.longer);
    }

    double tolerance_;
    bool clamps_neighbours_;
    std::vector<Node> nodes_;
    std::vector<Cell> cells_;            // by node
    std::vector<std::uint32_t> parent_;  // by node
    std::vector<Held> records_;
    std::vector<std::uint32_t> node_of_;  // by record
};

/// Tells touches to a recorder of walks as the elements that IrradianceOctree::share_structure() has.
template <class Recorder>
struct OctreeElements {
    Recorder& recorder;
    std::uint32_t nodes;
    void node(std::uint32_t number) { recorder.visit(number); }
    void record(std::uint32_t number) { recorder.visit(nodes + number); }
};

}  // namespace regather::capture
