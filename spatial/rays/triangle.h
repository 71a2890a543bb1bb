// spatial/rays/triangle.h -- a triangle soup as the ray-casting structures take it, and the boxes of its
// triangles [scene units].
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "trace/bounds.h"
#include "trace/vec.h"

namespace regather::spatial {

using TriangleIndices = std::array<std::uint32_t, 3>;  ///< Into the vertices.

/// One box a triangle. Throws trace::DataError, which names the triangle, for an index past the vertices, a
/// vertex that is not finite, and one farther than 1e18 from 0 (the areas of such boxes would overflow).
std::vector<trace::Bounds3> triangle_bounds(std::span<const trace::Vec3> vertices,
                                            std::span<const TriangleIndices> triangles);

/// The cross product of the edges from `a` to `b` and to `c`, in double precision: along the normal by the
/// winding, twice the area long [scene units^2]. 0 where the corners are on one line, as long as the edges
/// are doubles.
std::array<double, 3> across(trace::Vec3 a, trace::Vec3 b, trace::Vec3 c);

}  // namespace regather::spatial
