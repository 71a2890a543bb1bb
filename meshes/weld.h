// meshes/weld.h -- what the triangles of a mesh have to do with each other: which vertices are one place,
// which triangles hang together, whether they close a volume; normals by crease angle; sheets of glass as
// solids; fewer triangles.
#pragma once
#include <cstdint>
#include <vector>

#include "meshes/surface.h"

namespace regather::meshes {

/// One number a vertex: equal for vertices at equal coordinates, numbered from 0 by first appearance.
std::vector<std::uint32_t> weld(const Surface& surface);

/// A normal at each corner: the mean, by area, of the triangles around it whose own normals differ by less
/// than `crease_degrees`. Vertices are split where corners disagree. A surface that has normals keeps them.
Surface with_smooth_normals(const Surface& surface, double crease_degrees);

/// For a dielectric, which must be closed and face outward. Each part that hangs together and is closed is
/// turned to face outward (unless it lies within another part: a cavity); each that is not closed becomes a
/// sheet `thickness` thick.
Surface as_solid(const Surface& surface, float thickness);

/// All vertices in a cube of a grid of `cell` become their mean, and triangles that lose their area go
/// (Rossignac & Borrel, "Multi-resolution 3D approximations for rendering complex scenes", 1993). Normals are
/// left out.
Surface simplified(const Surface& surface, float cell);

}  // namespace regather::meshes
