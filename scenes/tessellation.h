// scenes/tessellation.h -- triangles of the shapes that a scene file can name: quads, boxes, spheres and
// rippled water; surfaces of revolution are in scenes/revolution.h. Lengths in metres. Triangles are
// counter-clockwise seen from outside. A closed shape is watertight to the last bit: each edge is shared by
// exactly two triangles whose corners there are equal, seen in opposite directions.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "meshes/surface.h"
#include "trace/vec.h"

namespace regather::scenes {

using meshes::Surface;
using meshes::triangle_area;
using trace::Vec3;

struct Quad {
    Vec3 corner, edge_u, edge_v;                ///< Faces along cross(edge_u, edge_v).
    std::array<std::uint32_t, 2> divide{1, 1};  ///< Cells along edge_u and edge_v, >= 1.
};

/// The bilinear surface through four corners, flat or not, counter-clockwise seen from outside.
struct Patch {
    std::array<Vec3, 4> corners;
    std::array<std::uint32_t, 2> divide{1, 1};  ///< Cells from corner 0 to 1 and from corner 0 to 3, >= 1.
};

struct Box {
    Vec3 min, max;                                 ///< Before the rotation.
    double rotate_z_degrees = 0;                   ///< Counter-clockwise seen from above, about the centre.
    std::array<std::uint32_t, 3> divide{1, 1, 1};  ///< Cells along x, y and z, >= 1.
};

struct Sphere {
    Vec3 center;
    float radius = 1;
    std::uint32_t segments = 32;  ///< Around the z axis, >= 3; half as many (at least 2) from pole to pole.
};

/// A square of water, seen from above, whose surface is z = center.z + amplitude cos(2 pi (r / wavelength) -
/// phase), r the distance from the centre: the circular waves of a drop.
struct Ripple {
    Vec3 center;  ///< On the still surface.
    float size = 1, amplitude = 0.01f,
          wavelength = 0.2f;  ///< Edge of the square, half of crest to trough [m].
    double phase_degrees = 0;
    float depth = 0;  ///< [m] From the still surface to a flat bottom, > amplitude: a closed shape; 0: the
                      ///< surface alone.
    std::uint32_t cells = 64;  ///< Along each edge, >= 1.
};

/// The two triangles of each cell of an (nu + 1) x (nv + 1) grid of vertices that starts at `first`, u
/// fastest; they face along u x v.
void add_grid_triangles(Surface& surface, std::uint32_t first, std::uint32_t nu, std::uint32_t nv);

std::uint64_t triangle_count(const Quad&);
std::uint64_t triangle_count(const Patch&);
std::uint64_t triangle_count(const Box&);
std::uint64_t triangle_count(const Sphere&);
std::uint64_t triangle_count(const Ripple&);

Surface tessellate(const Quad&);
Surface tessellate(const Patch&);
Surface tessellate(const Box&);
Surface tessellate(const Sphere&);  ///< With smooth normals.
Surface tessellate(const Ripple&);  ///< With smooth normals on the water's surface.

}  // namespace regather::scenes
