// capture/sampling/footprints.h -- directions by the footprints that photons leave on the hemisphere: each a
// disc about where it came from, small where many came from, wide where few did (Hey & Purgathofer,
// "Importance Sampling with Hemispherical Particle Footprints", SCCG 2002).
#pragma once
#include <memory>
#include <span>

#include "capture/sampling/gather_distribution.h"

namespace regather::capture {

std::span<const trace::Parameter> footprint_parameters();
/// A disc on the doubled sphere (capture/sampling/doubled_guide.h) for each photon that is_witness(), chosen
/// by the photon's power and sampled evenly, so that the density is exact: the sum over the discs that
/// overlap, times the cosine. It reaches as far as the photon's so many nearest in direction.
std::unique_ptr<GatherDistribution> make_footprints(const trace::Parameters& given, const PhotonGuide& guide);

}  // namespace regather::capture
