#include "capture/light/light_probe.h"

#include <algorithm>

#include "capture/light/surface.h"

namespace regather::capture {

Vec3 LightProbe::seen(Vec3 origin, Vec3 direction) const {
    constexpr int most_specular = 16;
    Vec3 throughput{1, 1, 1};
    for (int specular = 0; specular <= most_specular; ++specular) {
        const std::optional<Hit> hit = caster_.closest(origin, direction);
        if (!hit) return {};
        const Vec3 incoming = -direction;
        const Surface at = surface_at(scene_, *hit, incoming);
        if (!is_specular(*at.material)) {
            spatial::NearestSet found(std::min(config_.k, photons_.size()), config_.radius);
            spatial::nearest(photons_, hit->position, found);
            return throughput * reflected_radiance(photons_, found, {at.material, at.normal, incoming},
                                                   config_.filter, config_.surface_check);
        }
        Vec3 through;
        const bool mirror = at.material->kind == MaterialKind::mirror;
        const float share = mirror ? 1 : fresnel(dot(incoming, at.normal), at.eta());
        if (share < 0.5f && refracted(at, incoming, through)) {
            throughput = throughput * ((1 - share) / (at.eta() * at.eta()));
            origin = caster_.offset(hit->position, -at.side);
            direction = through;
        } else {
            throughput = throughput * (mirror ? at.material->specular : Vec3{share, share, share});
            origin = caster_.offset(hit->position, at.side);
            direction = reflected(at, incoming);
        }
    }
    return {};
}

}  // namespace regather::capture
