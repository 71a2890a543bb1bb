// meshes/surface.h -- triangles in space, the value that readers of mesh files and makers of shapes give.
// Lengths in the units of their source, metres in a scene. Triangles are counter-clockwise seen from outside.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "trace/vec.h"

namespace regather::meshes {

using trace::Vec3;
using Triangle = std::array<std::uint32_t, 3>;  ///< Indices of its corners.

/// More than so many are refused, in a mesh as in a scene.
inline constexpr std::uint64_t most_triangles = 50'000'000, most_vertices = 3 * most_triangles;

struct Surface {
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals;  ///< One a vertex, unit length; zero where the surface is flat-shaded.
    std::vector<Triangle> triangles;
};

/// Of the triangle a, b, c, in double precision.
double triangle_area(Vec3 a, Vec3 b, Vec3 c);

/// How many triangles have no area in float coordinates.
std::uint64_t degenerate_count(const Surface&);

/// Takes those triangles out and tells how many they were; of `tags`, one a triangle, those that belong to
/// them.
std::uint64_t drop_degenerate(Surface&, std::vector<std::uint32_t>* tags = nullptr);

/// Takes out the vertices that no triangle names; the others keep their order.
void drop_unused_vertices(Surface&);

}  // namespace regather::meshes
