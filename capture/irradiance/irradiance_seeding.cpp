#include "capture/irradiance/irradiance_seeding.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace regather::capture {
namespace {

constexpr std::size_t batch_points = 4096;  // whose samples are held at once

}  // namespace

IrradianceSeeding::IrradianceSeeding(std::span<const SeedPoint> points, const IrradianceCacheSpec& spec,
                                     const HemisphereGrid& grid, const trace::Bounds3& box, double far)
    : points_(points),
      spec_(spec),
      grid_(grid),
      box_(box),
      far_(far),
      octree_(box, spec.tolerance(), spec.clamps_neighbours()),
      step_(std::max(spec.overture(), 1u)) {}

std::vector<std::uint32_t> IrradianceSeeding::points_of_round(std::uint32_t step, bool first) const {
    const bool last = step == 1;
    // In the overture a grid's points of the grid before have been looked up there.
    const auto is_on = [](const SeedPoint& at, std::uint32_t of) {
        return at.column % of == 0 && at.row % of == 0;
    };
    std::vector<std::uint32_t> points;
    for (std::uint32_t i = 0; i < points_.size(); ++i)
        if (is_on(points_[i], step) && (first || last || !is_on(points_[i], 2 * step))) points.push_back(i);
    return points;
}

bool IrradianceSeeding::next(std::vector<std::uint32_t>& wanted) {
    wanted.clear();
    if (step_ == 0) return false;
    const std::uint32_t step = step_;
    const bool first = rounds_.empty(), last = step == 1;
    SeedingRound round{step, last ? spec_.tolerance() : spec_.tolerance() / 2, 0, 0};
    const std::vector<std::uint32_t> asked = points_of_round(step, first);
    std::vector<std::uint8_t> is_served(asked.size());
    tbb::parallel_for(std::size_t{0}, asked.size(), [&](std::size_t i) {
        octree_.search(points_[asked[i]].point, round.tolerance, [&](std::uint32_t) { is_served[i] = 1; });
    });
    for (std::size_t i = 0; i < asked.size(); ++i)
        if (is_served[i] == 0) wanted.push_back(asked[i]);
    round.asked = asked.size();
    round.gathered = wanted.size();
    rounds_.push_back(round);
    wanted_ = wanted;
    made_.clear();
    step_ = last ? 0 : step / 2;
    return true;
}

void IrradianceSeeding::add(std::span<const Incoming> incoming) {
    const std::size_t begin = made_.size(), count = incoming.size() / grid_.cells();
    made_.resize(begin + count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const SeedPoint& at = points_[wanted_[begin + i]];
        made_[begin + i] = make_record(
            spec_, {grid_, at.point, incoming.subspan(i * grid_.cells(), grid_.cells()), at.spacing, far_});
    });
    if (made_.size() < wanted_.size()) return;
    for (const IrradianceRecord& record : made_) octree_.insert(record);
    point_of_record_.insert(point_of_record_.end(), wanted_.begin(), wanted_.end());
    unclamped_.insert(unclamped_.end(), made_.begin(), made_.end());
}

void seed(IrradianceSeeding& seeding, const HemisphereGrid& grid, const HemisphereGather& gather) {
    std::vector<std::uint32_t> wanted;
    std::vector<Incoming> incoming;
    while (seeding.next(wanted))
        for (std::size_t first = 0; first < wanted.size(); first += batch_points) {
            const std::size_t count = std::min(batch_points, wanted.size() - first);
            incoming.assign(count * grid.cells(), {});
            tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
                gather(wanted[first + i], std::span(incoming).subspan(i * grid.cells(), grid.cells()));
            });
            seeding.add(incoming);
        }
}

}  // namespace regather::capture
