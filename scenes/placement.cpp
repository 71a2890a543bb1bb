#include "scenes/placement.h"

#include <cmath>
#include <numbers>

namespace regather::scenes {

using trace::Vec3;

void Placement::turn(double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    cosine = std::cos(angle);
    sine = std::sin(angle);
}

void Placement::apply(meshes::Surface& surface) const {
    for (Vec3& v : surface.vertices) {
        if (y_is_up) v = {v.x, -v.z, v.y};
        const double x = scale * v.x, y = scale * v.y;
        v = {static_cast<float>(cosine * x - sine * y + translate[0]),
             static_cast<float>(sine * x + cosine * y + translate[1]),
             static_cast<float>(scale * v.z + translate[2])};
    }
    for (Vec3& n : surface.normals) {
        if (y_is_up) n = {n.x, -n.z, n.y};
        n = {static_cast<float>(cosine * n.x - sine * n.y), static_cast<float>(sine * n.x + cosine * n.y),
             n.z};
    }
}

}  // namespace regather::scenes
