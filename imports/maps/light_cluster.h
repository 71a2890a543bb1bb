// imports/maps/light_cluster.h -- cuts a surface that gives off light into lights: samplers choose among
// lights by where they are, so each should be in one place. Lengths are those of the surface.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "scenes/tessellation.h"

namespace regather::imports {

using scenes::Surface;

/// For each surface its parts. At first one part for triangles that hang together (corners of equal
/// position); while all surfaces together have more than `most` parts, those of one surface whose boxes'
/// centres lie in the same cell of a cubic grid become one, the cells twice as large each time, 1 at first.
/// At least one part a surface that has triangles. No triangle is lost; parts are in the order of their first
/// triangles.
std::vector<std::vector<Surface>> cluster_lights(std::span<const Surface> surfaces, std::size_t most);

}  // namespace regather::imports
