// scenes/placement.h -- how a mesh or an object is put into a scene.
#pragma once
#include <array>

#include "meshes/surface.h"

namespace regather::scenes {

/// y becomes z (where `y_is_up`), then scale, turn about the z axis, move.
struct Placement {
    bool y_is_up = false;
    double scale = 1, cosine = 1, sine = 0;  ///< Of the angle by which it turns.
    std::array<double, 3> translate{};       ///< [m]

    void turn(double degrees);
    void apply(meshes::Surface& surface) const;
};

}  // namespace regather::scenes
