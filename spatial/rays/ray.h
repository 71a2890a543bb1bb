// spatial/rays/ray.h -- a ray, and what it asks for. Lengths in scene units, distances in lengths of the
// direction.
#pragma once
#include <limits>

#include "trace/vec.h"

namespace regather::spatial {

/// Finite; the direction is not zero. Hits count at distances over `nearest` (0 or more) up to `farthest`.
struct Ray {
    trace::Vec3 origin, direction;
    float nearest = 0, farthest = std::numeric_limits<float>::infinity();
};

}  // namespace regather::spatial
