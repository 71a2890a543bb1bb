// imports/orbit.h -- a camera path round an object: a part of a circle at a constant height, looking at its
// middle.
#pragma once
#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace regather::imports {

using scenes::KeyFrame;
using trace::Vec3;

struct Orbit {
    Vec3 center;                                ///< [m] What the camera looks at.
    double distance = 1, height = 0;            ///< [m] From the centre, level; above it.
    double from_degrees = 0, to_degrees = 360;  ///< 0 looks along +x from the centre, 90 along +y.
    std::uint32_t frames = 36;                  ///< >= 2.
};

/// Keys at least every 10 degrees, so that the smooth curve through them is the circle to 0.1 %.
std::vector<KeyFrame> keys_of(const Orbit& orbit);

}  // namespace regather::imports
