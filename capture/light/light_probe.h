// capture/light/light_probe.h -- what a ray sees of the light that surfaces reflect, as the photon map tells
// it.
#pragma once
#include "capture/gather_pass.h"
#include "capture/ray_caster.h"

namespace regather::capture {

/// One for any number of threads; scene, caster and photons outlive it.
class LightProbe {
public:
    LightProbe(const Scene& scene, const RayCaster& caster, const spatial::PhotonKd& photons,
               const GatherConfig& config)
        : scene_(scene), caster_(caster), photons_(photons), config_(config) {}

    /// [W / (m^2 sr)] Reflected towards the ray's origin by the first surface that is not specular; through
    /// up to 16 specular ones, each by its stronger branch alone. What lights send themselves is not in it.
    Vec3 seen(Vec3 origin, Vec3 direction) const;

private:
    const Scene& scene_;
    const RayCaster& caster_;
    const spatial::PhotonKd& photons_;
    GatherConfig config_;
};

}  // namespace regather::capture
