// capture/irradiance/irradiance_seeding.h -- which points of a picture get records of irradiance, in rounds
// that any number of threads make alike: all points of a round are looked up in the records of the rounds
// before, and what is gathered is inserted in the order of the points.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "capture/irradiance/irradiance_metric.h"
#include "capture/irradiance/irradiance_octree.h"
#include "trace/bounds.h"

namespace regather::capture {

/// A diffuse point that a pixel shows.
struct SeedPoint {
    IrradiancePoint point;
    std::uint32_t column = 0, row = 0;  ///< Of the pixel.
    double spacing = 0;                 ///< As GatheredHemisphere's.
};

struct SeedingRound {
    std::uint32_t step = 1;      ///< Every so many pixels along a row, and every so many rows.
    double tolerance = 0;        ///< Ward's a.
    std::uint64_t asked = 0;     ///< Points that were looked up.
    std::uint64_t gathered = 0;  ///< Those that no record served.
};

/// The overture goes over ever finer grids of pixels, each half as wide as the one before, down to every
/// second pixel, at half the tolerance, so that later points lie between records and not at their far ends
/// (radiance and Krivanek et al. 2006 make one). The last round goes over all points at the tolerance itself.
class IrradianceSeeding {
public:
    /// Points pixel by pixel; they outlive it. `box` holds them. `far` and `grid` as GatheredHemisphere's.
    IrradianceSeeding(std::span<const SeedPoint> points, const IrradianceCacheSpec& spec,
                      const HemisphereGrid& grid, const trace::Bounds3& box, double far);

    /// The points of the next round that no record serves, ascending; false when there is no further round.
    /// What the one before wanted has been added.
    bool next(std::vector<std::uint32_t>& wanted);
    /// Of the first points that the round wants and have not been added: samples of the grid's cells for
    /// each.
    void add(std::span<const Incoming> incoming);

    const IrradianceOctree& octree() const { return octree_; }
    const SeedPoint& point(std::uint32_t number) const { return points_[number]; }
    /// By record: its point's number.
    std::span<const std::uint32_t> point_of_record() const { return point_of_record_; }

    /// All that was looked up and inserted once more, in an octree that grows again as this one did. `lookup`
    /// and `insertion` are called with a point's number and a function that does it and tells a listener what
    /// it touches; the points of a round ascending, then its records as they come. Not before the end.
    template <class Lookup, class Insertion>
    void tell_again(Lookup&& lookup, Insertion&& insertion) const {
        IrradianceOctree octree(box_, spec_.tolerance(), spec_.clamps_neighbours());
        std::size_t record = 0;
        for (std::size_t r = 0; r < rounds_.size(); ++r) {
            for (const std::uint32_t number : points_of_round(rounds_[r].step, r == 0))
                lookup(number, [&](auto& listener) {
                    octree.search(
                        points_[number].point, rounds_[r].tolerance, [](std::uint32_t) {}, listener);
                });
            for (const std::size_t end = record + rounds_[r].gathered; record < end; ++record)
                insertion(point_of_record_[record],
                          [&](auto& listener) { octree.insert(unclamped_[record], listener); });
        }
    }
    /// As far as they have come.
    std::span<const SeedingRound> rounds() const { return rounds_; }

private:
    std::vector<std::uint32_t> points_of_round(std::uint32_t step, bool first) const;

    std::span<const SeedPoint> points_;
    const IrradianceCacheSpec& spec_;
    const HemisphereGrid& grid_;
    const trace::Bounds3 box_;
    const double far_;
    IrradianceOctree octree_;
    std::uint32_t step_;  // of the round to come; 0: none comes
    std::vector<SeedingRound> rounds_;
    std::vector<std::uint32_t> wanted_;
    std::vector<IrradianceRecord> made_;  // of the first of wanted_
    std::vector<std::uint32_t> point_of_record_;
    std::vector<IrradianceRecord> unclamped_;  // as they were inserted
};

/// Writes the samples of the grid's cells about a point of a number. Called by any number of threads.
using HemisphereGather = std::function<void(std::uint32_t point, std::span<Incoming> incoming)>;
/// All rounds.
void seed(IrradianceSeeding& seeding, const HemisphereGrid& grid, const HemisphereGather& gather);

}  // namespace regather::capture
