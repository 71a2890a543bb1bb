// capture/irradiance/irradiance_pass.h -- records of irradiance for the diffuse points that a picture shows:
// the queries of their hemispheres in batches, to be searched like any, and what they bring.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "capture/irradiance/gather_scatter.h"
#include "capture/irradiance/irradiance_seeding.h"
#include "capture/irradiance/waiting_pixels.h"
#include "capture/pixel_paths.h"

namespace regather::capture {

class IrradiancePass {
public:
    /// Follows the eye rays. Scene, caster, lights and config outlive the pass. UsageError for what
    /// QueryConfig::irradiance_cache may not be.
    IrradiancePass(const Scene& scene, const RayCaster& caster, const LightSampler& lights,
                   const QueryConfig& config, PassParts parts);

    /// Casts the rays of the next points that get records; false when there are none. The same work on any
    /// number of threads, point by point, cell by cell. A query's weight is that in the sum of the point's
    /// own pixel.
    bool next(PixelWork& work);
    /// What photons say of the queries of the last batch.
    void add(std::span<const Vec3> radiance, Nonfinite& nonfinite);

    const IrradianceOctree& octree() const { return seeding_->octree(); }
    std::span<const SeedingRound> rounds() const { return seeding_->rounds(); }
    /// Rays a record.
    std::uint32_t rays() const { return grid_.cells(); }
    const IrradianceSeeding& seeding() const { return *seeding_; }

    /// When all records are made, as if each took a while.
    WaitingPixels waiting() const;
    /// When all records are made: gather_scatter() of the points that gather, be it for a record.
    double scatter() const;
    /// Of all points: without records.
    double scatter_of_all() const;

private:
    void find_points();

    const Scene& scene_;
    const RayCaster& caster_;
    const LightSampler& lights_;
    const QueryConfig& config_;
    const PassParts parts_;
    const IrradianceCacheSpec spec_;
    const HemisphereGrid grid_;
    std::vector<PixelPaths::DiffusePoint> found_;
    std::vector<SeedPoint> points_;  // beside found_
    std::unique_ptr<IrradianceSeeding> seeding_;
    std::vector<std::uint32_t> wanted_;  // by the round
    std::size_t begun_ = 0;              // of wanted_
    // Of the batch:
    std::vector<Incoming> incoming_;
    std::vector<std::uint32_t> query_;
    std::vector<Vec3> factor_;  // by query
};

}  // namespace regather::capture
