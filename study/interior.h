// study/interior.h -- the pixels whose photon gathers stay on one flat surface: there the bias of a density
// estimate goes with the square of its radius; within a radius of an edge part of the disc has no photons,
// and the bias is of order 1.
#pragma once
#include <cstdint>
#include <vector>

#include "capture/ray_caster.h"

namespace regather::study {

/// 1 for each pixel whose centre shows a diffuse or glossy, dark surface that is flat and uncovered for
/// `radius` [scene units] around, by rays to 32 points around; else 0.
std::vector<std::uint8_t> interior(const scenes::Scene& scene, const capture::RayCaster& caster,
                                   std::uint32_t width, std::uint32_t height, double radius);

}  // namespace regather::study
