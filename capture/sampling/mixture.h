// capture/sampling/mixture.h -- some gather rays by the BRDF and the others by where photons came from, each
// weighted by what all of them do (multiple importance sampling; Veach & Guibas, "Optimally Combining
// Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995).
#pragma once
#include <memory>
#include <span>

#include "capture/sampling/gather_distribution.h"

namespace regather::capture {

std::span<const trace::Parameter> mixture_parameters();
std::unique_ptr<GatherDistribution> make_mixture(const trace::Parameters& given, const PhotonGuide& guide);

}  // namespace regather::capture
