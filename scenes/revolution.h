// scenes/revolution.h -- triangles of surfaces of revolution: lathes, cylinders (and cones) and tori. Lengths
// in metres. As in scenes/tessellation.h, triangles face outward and closed shapes are watertight to the last
// bit.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "scenes/tessellation.h"

namespace regather::scenes {

/// A profile of points (radius, height), turned about the vertical axis through `center`. The outside lies on
/// the right of the profile's course: upwards it faces away from the axis. Closed when the profile begins and
/// ends on the axis (radius 0), or ends where it began; else open, and one-sided like any surface.
struct Lathe {
    Vec3 center;                                ///< Height 0 on the axis.
    std::vector<std::array<float, 2>> profile;  ///< At least 2 points, radii >= 0, no point twice in a row.
    std::uint32_t segments = 32;                ///< Around the axis, >= 3.
    bool smooth = true;  ///< Shaded round: about the axis, and along the profile where it turns by less than
                         ///< 45 degrees.
};

/// Closed, from one disc to the other; a cone with two different radii, at most one of them 0.
struct Cylinder {
    Vec3 from, to;  ///< Centres of the discs, apart.
    float radius = 1, radius_to = 1;
    std::uint32_t segments = 32;
    bool smooth = true;  ///< Shaded round about its axis; flat, one with 3 segments is a prism.
};

struct Torus {
    Vec3 center, axis{0, 0, 1};
    float radius = 1,
          tube = 0.25f;  ///< From the centre to the tube's middle; of the tube, less than the former.
    std::uint32_t segments = 48, tube_segments = 16;  ///< Around the axis; around the tube; each >= 3.
};

std::uint64_t triangle_count(const Lathe&);
std::uint64_t triangle_count(const Cylinder&);
std::uint64_t triangle_count(const Torus&);

Surface tessellate(const Lathe&);
Surface tessellate(const Cylinder&);  ///< The discs are flat.
Surface tessellate(const Torus&);     ///< With smooth normals.

}  // namespace regather::scenes
