// scenes/shape.h -- the shapes of a scene file that are made here and not read from a mesh file: from their
// JSON to triangles.
#pragma once
#include <cstdint>
#include <variant>

#include "scenes/coordinates.h"
#include "scenes/revolution.h"
#include "scenes/terrain.h"
#include "scenes/tessellation.h"
#include "scenes/tuft.h"

namespace regather::scenes {

using Shape = std::variant<Quad, Patch, Box, Sphere, Cylinder, Lathe, Torus, Ripple, Terrain, Tuft>;

/// An object of one of shape_kinds() other than mesh and instances, or a rectangle or sphere light, which has
/// the keys of a quad without division or of a sphere. Refuses what is wrong in it.
Shape read_shape(const Field& node, const Kind& kind, const Coordinates& coordinates);

std::uint64_t triangle_count(const Shape& shape);
Surface tessellate(const Shape& shape);

}  // namespace regather::scenes
