#include "capture/irradiance/irradiance_octree.h"

#include <fmt/format.h>

#include "trace/error.h"

namespace regather::capture {
namespace {

constexpr std::uint32_t most_records = 1u << 30;
constexpr double cell_slack = 1 + 0x1p-30;  // what errors of rounding may add to a distance

}  // namespace

IrradianceOctree::IrradianceOctree(const trace::Bounds3& box, double tolerance, bool clamps_neighbours)
    : tolerance_(tolerance), clamps_neighbours_(clamps_neighbours) {
    Cell root;
    if (!box.empty()) {
        const Vec3d low = box.min, high = box.max;
        root.middle = (low + high) * 0.5;
        root.half = trace::max_component(high - low) * 0.5 * cell_slack;
    }
    nodes_.push_back({{none, none, none, none, none, none, none, none}, none, none});
    cells_.push_back(root);
    parent_.push_back(0);
}

bool IrradianceOctree::descends(const IrradianceRecord& record, std::uint32_t node,
                                std::uint32_t& octant) const {
    const Cell& cell = cells_[node];
    // A child is as wide as half of this cell.
    if (cell.level == most_levels || !(cell.half > 0) ||
        cell.half < 2 * reach_of(record, tolerance_) * cell_slack || !(distance(cell, record.position) <= 0))
        return false;
    octant = 0;
    for (int axis = 0; axis < 3; ++axis)
        octant = octant << 1 |
                 static_cast<std::uint32_t>(static_cast<double>(record.position[axis]) >= cell.middle[axis]);
    return true;
}

std::uint32_t IrradianceOctree::add_child(std::uint32_t node, std::uint32_t octant) {
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    Cell cell = cells_[node];
    cell.half /= 2;
    ++cell.level;
    for (int axis = 0; axis < 3; ++axis)
        cell.middle[axis] += (octant >> (2 - axis) & 1) != 0 ? cell.half : -cell.half;
    nodes_.push_back({{none, none, none, none, none, none, none, none}, none, none});
    cells_.push_back(cell);
    parent_.push_back(node);
    nodes_[node].child[octant] = child;
    return child;
}

std::uint32_t IrradianceOctree::append(const IrradianceRecord& record, std::uint32_t node) {
    if (records_.size() >= most_records)
        throw trace::UsageError(
            fmt::format("irradiance cache: more than {} records, expected fewer", most_records));
    const std::uint32_t number = size();
    records_.push_back({record, none});
    node_of_.push_back(node);
    Node& cell = nodes_[node];
    if (cell.first == none)
        cell.first = number;
    else
        records_[cell.last].next = number;
    cell.last = number;
    return number;
}

std::shared_ptr<const spatial::Listed> IrradianceOctree::share_structure(std::string name) const {
    spatial::Listed::Elements elements;
    elements.ranges.push_back({trace::Region::nodes, 0, nodes()});
    if (size() > 0) elements.ranges.push_back({trace::Region::irradiance, nodes(), size()});
    elements.parent = parent_;
    elements.parent.insert(elements.parent.end(), node_of_.begin(), node_of_.end());
    elements.bytes.assign(nodes(), node_bytes);
    elements.bytes.resize(std::size_t{nodes()} + size(), record_bytes);
    elements.node_bytes = node_bytes;
    return std::make_shared<spatial::Listed>(std::move(name), std::move(elements));
}

}  // namespace regather::capture
