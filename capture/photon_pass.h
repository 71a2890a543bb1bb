// capture/photon_pass.h -- photon tracing (Jensen 2001, chapters 5 and 9; the paper, section 5.1): photons
// leave the lights, are stored at diffuse and glossy surfaces, and go on or are absorbed by Russian roulette.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "capture/light/lights.h"
#include "capture/nonfinite.h"
#include "capture/ray_caster.h"
#include "trace/photon.h"

namespace regather::capture {

/// Which photons are stored. A caustic photon has met specular surfaces, one at least, and nothing else since
/// its light.
enum class PhotonKind : std::uint8_t {
    all,              ///< The global map, for gathers at the ends of gather rays.
    all_but_caustic,  ///< The global map beside a caustic map, when both are seen directly.
    caustic,          ///< The caustic map: a path ends at its first diffuse or glossy surface.
};

struct PhotonConfig {
    std::uint32_t photons = 1'000'000;  ///< To store; the paper, Table 1.
    std::uint64_t seed = 1;
    PhotonKind kind = PhotonKind::all;
    std::uint32_t paths_per_photon =
        100;  ///< With 100,000 more, the most that are traced for each photon asked for.
};

/// What a photon has met before the surface that stores it.
enum class PhotonOrigin : std::uint8_t { light, specular, surface };

using Power = std::array<double, 3>;  ///< [W] per RGB channel.

/// Where the power went. A photon's flight starts at a light (emitted) or a surface (reflected) and ends in
/// one of the others, so emitted + reflected = stored + not_stored + escaped + absorbed_by_specular +
/// cut_off, to rounding.
struct PhotonTally {
    Power emitted{}, reflected{}, stored{}, escaped{}, absorbed_by_specular{};
    Power not_stored{};  ///< Met a surface that would store photons, but not this kind.
    Power cut_off{};  ///< Of the last path beyond the asked number, and after 10,000 specular surfaces in a
                      ///< row.
    std::uint64_t paths = 0;  ///< Photons emitted.
    Nonfinite nonfinite;      ///< Photons that were left out.
};

struct PhotonPass {
    std::vector<trace::Photon> photons;  ///< In path order; the split axes are 0.
    std::vector<PhotonOrigin>
        origin;  ///< Of each: nothing since its light, specular surfaces alone, or others.
    PhotonTally tally;
};

/// Exactly config.photons photons; fewer when that takes more than the paths allowed, none without lights.
/// The same on any number of threads.
PhotonPass trace_photons(const Scene& scene, const RayCaster& caster, const LightSampler& lights,
                         const PhotonConfig& config);

}  // namespace regather::capture
