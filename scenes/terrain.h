// scenes/terrain.h -- uneven ground: a rectangle whose heights are value noise. Lengths in metres.
#pragma once
#include <array>
#include <cstdint>

#include "meshes/surface.h"
#include "trace/vec.h"

namespace regather::scenes {

using meshes::Surface;
using trace::Vec3;

/// Seen from above, the rectangle from `corner` along x and y. Its height differs from the corner's by at
/// most `amplitude`: three octaves of value noise, each of half the amplitude and wavelength of the one
/// before it. The knots, a wavelength apart, have heights drawn from the seed; between them runs the quintic
/// of Perlin
/// ("Improving noise", SIGGRAPH 2002), so that slopes and curvatures are continuous.
struct Terrain {
    Vec3 corner;
    std::array<float, 2> size{1, 1};
    float amplitude = 0.1f, wavelength = 1;
    std::uint32_t seed = 0;
    std::array<std::uint32_t, 2> cells{32, 32};  ///< Along x and y, two triangles each, >= 1.
};

/// A place of the ground, and how steeply it rises along x and y.
struct Ground {
    double height, slope_x, slope_y;  ///< The height above the corner's.
};

/// `x`, `y` from the corner. The triangles are chords of this surface: they meet it at the cells' corners.
Ground ground_at(const Terrain& terrain, double x, double y);

std::uint64_t triangle_count(const Terrain&);
Surface tessellate(const Terrain&);  ///< Faces up, with smooth normals; open.

}  // namespace regather::scenes
