// imports/homes/polygon.h -- triangles of a polygon in the plane, by ear clipping (Meisters, "Polygons Have
// Ears", 1975).
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "imports/homes/home.h"

namespace regather::imports {

/// Twice the area, positive when the corners run counter-clockwise with y up (clockwise on a plan, where y is
/// down).
double twice_area(std::span<const PlanPoint> polygon);

/// Indices into the polygon, every triangle running as the polygon does; corners without an area are passed
/// over. A simple polygon is covered exactly; one that crosses itself gives some triangles, and ends.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const PlanPoint> polygon);

}  // namespace regather::imports
