// capture/sampling/photon_guide.h -- the photons about a shaded point as witnesses of where its light comes
// from.
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>

#include "capture/photon_pass.h"
#include "capture/radiance_estimate.h"
#include "spatial/photons/nearest.h"

namespace regather::capture {

/// The global map, and of each of its photons where it came from. Photons that came from a light without
/// meeting a surface are no witnesses, as shadow rays see that light; nor are those that specular surfaces
/// alone have turned, where a caustic map sees them.
struct PhotonGuide {
    spatial::PhotonKd photons;
    std::span<const PhotonOrigin> origin = {};  ///< In the order of the photons.
    bool caustics_apart = false;
    /// [W / (m^2 sr)] What a gather ray finds, nothing kept or counted: light that surfaces reflect, as the
    /// photons tell, by way of specular surfaces too, none that lights send.
    std::function<Vec3(Vec3 origin, Vec3 direction)> seen = {};

    bool is_witness(std::uint32_t photon, const GatherPoint& at) const {
        if (origin[photon] == PhotonOrigin::light) return false;
        if (origin[photon] == PhotonOrigin::specular && caustics_apart) return false;
        return is_used(photons.nodes()[photon], at, true);
    }
    /// Of the photons nearest to `position`, as many as `found` holds, each that is one: f(where from, power
    /// [any unit]), in a repeatable order.
    template <class F>
    void for_each_witness(const GatherPoint& at, Vec3 position, spatial::NearestSet& found, F&& f) const {
        spatial::nearest(photons, position, found);
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (!is_witness(found[i].node, at)) continue;
            const trace::Photon& photon = photons.nodes()[found[i].node];
            f(-trace::decode_direction(photon), trace::decode_power(photon.power));
        }
    }
};

}  // namespace regather::capture
