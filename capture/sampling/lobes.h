// capture/sampling/lobes.h -- directions by the cosine times a mixture of von Mises-Fisher lobes that is
// fitted to the photons about the point, as path guiding does (Vorba et al., "On-line Learning of Parametric
// Mixture Models for Light Transport Simulation", SIGGRAPH 2014; Ruppert, Herholz & Lensch, "Robust Fitting
// of Parallax-Aware Mixtures for Path Guiding", SIGGRAPH 2020). The lobes are on the doubled sphere
// (capture/sampling/doubled_guide.h), so that their product with the cosine is exact.
#pragma once
#include <memory>
#include <span>

#include "capture/sampling/gather_distribution.h"

namespace regather::capture {

std::span<const trace::Parameter> lobe_parameters();
std::unique_ptr<GatherDistribution> make_lobes(const trace::Parameters& given, const PhotonGuide& guide);

}  // namespace regather::capture
