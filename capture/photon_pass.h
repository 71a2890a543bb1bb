// capture/photon_pass.h -- photon tracing (Jensen 2001, chapter 5; the paper, section 5.1): photons leave the lights, are
// stored at every diffuse or glossy surface they meet, and go on or are absorbed by Russian roulette.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "capture/ray_caster.h"
#include "trace/photon.h"

namespace regather::capture {

struct PhotonConfig {
    std::uint32_t photons = 1'000'000;  ///< To store; the paper, Table 1.
    std::uint64_t seed = 1;
};

using Power = std::array<double, 3>;  ///< [W] per RGB channel.

/// Where the power went. A photon's flight starts at a light (emitted) or a surface (reflected) and ends in one of the others, so
/// emitted + reflected = stored + escaped + absorbed_by_specular + cut_off, to rounding.
struct PhotonTally {
    Power emitted{}, reflected{}, stored{}, escaped{}, absorbed_by_specular{};
    Power cut_off{};           ///< Of the last path beyond the asked number, and after 10,000 bounces.
    std::uint64_t paths = 0;   ///< Photons emitted.
};

struct PhotonPass {
    std::vector<trace::Photon> photons;  ///< In path order; `flags` are 0.
    PhotonTally tally;
};

/// Exactly config.photons photons; fewer when the lights do not reach enough surfaces (100 paths a photon asked for), none
/// without lights. The same on any number of threads.
PhotonPass trace_photons(const Scene& scene, const RayCaster& caster, const PhotonConfig& config);

}  // namespace regather::capture
