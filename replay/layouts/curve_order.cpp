#include <algorithm>
#include <cassert>
#include <utility>

#include "reorder/cell.h"
#include "reorder/curve.h"
#include "replay/layouts/placement.h"
#include "trace/bounds.h"

namespace regather::replay {

Placement curve_order(const spatial::Structure& structure, std::span<const trace::Vec3> positions,
                      SpaceCurve curve) {
    const spatial::ElementRange photons = structure.range_of(trace::Region::photons);
    const auto is_photon = [&](std::uint32_t e) { return e - photons.first < photons.count; };
    Placement placement = depth_first_order(structure);
    std::erase_if(placement.elements, is_photon);

    trace::Bounds3 all;
    for (const trace::Vec3 position : positions) all.include(position);
    const reorder::CellGrid grid(all, std::uint32_t{1} << reorder::max_curve_bits);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> coded;
    coded.reserve(photons.count);
    for (std::uint32_t e = photons.first; e < photons.first + photons.count; ++e) {
        assert(structure.first_record(e) + structure.records(e) <= positions.size());
        trace::Bounds3 box;
        for (const trace::Vec3 position : positions.subspan(structure.first_record(e), structure.records(e)))
            box.include(position);
        const std::uint64_t morton = reorder::morton_code(grid.cell_of(box.min + (box.max - box.min) * 0.5f));
        coded.emplace_back(
            curve == SpaceCurve::morton ? morton : reorder::hilbert_code(morton, reorder::max_curve_bits), e);
    }
    std::sort(coded.begin(), coded.end());
    for (const auto& [code, element] : coded) placement.elements.push_back(element);
    return placement;
}

}  // namespace regather::replay
