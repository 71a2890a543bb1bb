// capture/irradiance/irradiance_estimate.h -- irradiance at a point, and how it changes when the point moves
// and its normal turns, of one sample of each stratum (Ward & Heckbert, "Irradiance Gradients", EGWR 1992).
#pragma once
#include <array>
#include <span>

#include "capture/irradiance/hemisphere_grid.h"
#include "capture/light/bsdf.h"

namespace regather::capture {

/// Gradients are by channel, in world space and at right angles to the normal.
struct IrradianceEstimate {
    Vec3d irradiance;  ///< [W / m^2]
    /// When the normal n turns to m, the channel changes by (n x m) . rotation, to first order [W / m^2 /
    /// rad].
    std::array<Vec3d, 3> rotation{};
    /// When the point moves by d, it changes by d . translation, to first order [W / m^2 / scene unit].
    std::array<Vec3d, 3> translation{};
    double harmonic_distance = 0;  ///< Harmonic mean over the cosine density; infinite where nothing is met.
    double nearest = 0;            ///< Infinite where nothing is met.

    double brightness() const { return irradiance.x + irradiance.y + irradiance.z; }
    /// Of all channels together.
    Vec3d brightness_translation() const { return translation[0] + translation[1] + translation[2]; }
};

/// Distances that are no numbers above this are counted as it [scene units].
inline constexpr double least_distance = 0x1p-100;

/// The distance of a sample, at least least_distance.
inline double distance_of(const Incoming& sample) {
    const auto distance = static_cast<double>(sample.distance);
    return distance > least_distance ? distance : least_distance;
}
/// The radiance of a sample; 0 where a channel is negative or not finite.
inline Vec3d radiance_of(const Incoming& sample) {
    const auto sane = [](float x) { return std::isfinite(x) && x > 0 ? static_cast<double>(x) : 0.0; };
    return {sane(sample.radiance.x), sane(sample.radiance.y), sane(sample.radiance.z)};
}

/// A sample for each cell of the grid, about the frame's normal. Between two neighbouring cells light is
/// taken to change where the nearer of the two surfaces ends, as Ward & Heckbert do. Finite for any samples,
/// but for distances where nothing is met.
IrradianceEstimate estimate_irradiance(const HemisphereGrid& grid, const Frame& frame,
                                       std::span<const Incoming> incoming);

}  // namespace regather::capture
