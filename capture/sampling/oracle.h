// capture/sampling/oracle.h -- the ceiling of what a table of directions can give: one that is made of the
// light that gather rays would find, at a cost that no renderer would pay.
#pragma once
#include <memory>
#include <span>

#include "capture/sampling/gather_distribution.h"

namespace regather::capture {

std::span<const trace::Parameter> oracle_parameters();

/// Of each cell the root of the mean square of what PhotonGuide::seen() tells at probes x probes places: the
/// density of least variance among those that are constant in a cell.
std::unique_ptr<GatherDistribution> make_oracle(const trace::Parameters& given, const PhotonGuide& guide);

}  // namespace regather::capture
