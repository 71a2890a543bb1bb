// capture/radiance_estimate.h -- equation 2 of the paper: reflected radiance from the photons that a search
// has found.
#pragma once
#include <array>
#include <cstdint>

#include "capture/light/bsdf.h"
#include "spatial/photons/nearest.h"
#include "spatial/photons/photon_kd.h"

namespace regather::capture {

/// Weight of a photon by its distance over the radius of the disc (Jensen 2001, section 7.2.1): a cone, 1 - t
/// / 1.1, or a Gaussian of beta = 1.953; divided by the weight's mean over the disc, so that an even
/// irradiance stays what it is.
enum class Filter : std::uint8_t { none, cone, gaussian };
inline constexpr std::array<const char*, 3> filter_names{"none", "cone", "gaussian"};

/// The surface that the photons are gathered for. `normal` has unit length and lies on the viewer's side.
struct GatherPoint {
    const Material* material;
    Vec3 normal, to_viewer;
};

/// Of a photon at `share2` = (distance / radius)^2, in [0, 1].
float filter_weight(Filter filter, float share2);

/// Whether a photon lights the surface: it comes from before it and, with `surface_check`, its own surface's
/// normal, where it tells one, is within 60 degrees.
bool is_used(const trace::Photon& photon, const GatherPoint& at, bool surface_check);

/// Of a full set, the farthest photon bounds the disc and is not counted: k - 1 photons lie in it at random,
/// and the mean of (k - 1) / area is the density (Mack & Rosenblatt, "Multivariate k-nearest neighbor density
/// estimates", 1979), while that of k / area is k / (k - 1) of it. Sum over the photons of f_r x power x
/// weight, over the area of their disc [W / (m^2 sr)]. Photons that come from behind the surface are not
/// used; with `surface_check`, nor are those whose own surface's normal is more than 60 degrees away (the
/// paper, section 6.2). Nothing found, or all at the point itself: 0.
Vec3 reflected_radiance(const spatial::PhotonKd& photons, const spatial::NearestSet& found,
                        const GatherPoint& at, Filter filter, bool surface_check);

}  // namespace regather::capture
