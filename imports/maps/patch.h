// imports/maps/patch.h -- curved surfaces of Quake III maps: biquadratic Bezier patches, nine control points
// each, in a net of odd width and height that shares the control points of neighbours (P. Bezier; the formula
// in G. Farin, "Curves and Surfaces for CAGD", 5th ed. 2002, section 14.1). Lengths are those of the control
// points.
#pragma once
#include <cstdint>
#include <vector>

#include "scenes/tessellation.h"

namespace regather::imports {

using scenes::Surface;
using trace::Vec3;

/// Control point (column, row) is points[row * width + column]. Width and height are odd, >= 3.
struct ControlNet {
    std::uint32_t width = 0, height = 0;
    std::vector<Vec3> points;
    std::vector<Vec3> normals;  ///< One a point: the outside of the surface.
};

std::uint64_t triangle_count(const ControlNet& net, std::uint32_t subdivision);

/// `subdivision` >= 1 steps along each side of each patch. The winding follows the control points' normals;
/// the vertex normals are those of the curved surface. Points of an edge depend on its own control points
/// alone and not on the direction in which they are named, so nets that share the points of an edge share the
/// vertices on it to the last bit. Zero-area triangles of collapsed edges are left in.
Surface tessellate(const ControlNet& net, std::uint32_t subdivision);

}  // namespace regather::imports
