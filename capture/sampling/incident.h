// capture/sampling/incident.h -- directions by a table of where photons about the point came from (Jensen,
// "Importance Driven Path Tracing Using the Photon Map", EGWR 1995), alone or times the surface's BRDF (the
// paper, section 7.3).
#pragma once
#include <memory>
#include <span>

#include "capture/sampling/gather_distribution.h"

namespace regather::capture {

std::span<const trace::Parameter> incident_parameters();

/// Of each photon that is_witness(), its power goes into the cell that it came from and, with smooth=1, half
/// of each cell's to its four neighbours.
std::unique_ptr<GatherDistribution> make_incident(const trace::Parameters& given, const PhotonGuide& guide);
/// The same table with each cell times the BRDF towards its middle: one table, one lookup. The floor is taken
/// of the BRDF times the cosine.
std::unique_ptr<GatherDistribution> make_combined(const trace::Parameters& given, const PhotonGuide& guide);

}  // namespace regather::capture
