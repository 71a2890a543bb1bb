// imports/homes/wall.h -- the walls of a home as closed solids, mitred where they are joined, with holes for
// doors and windows. In: centimetres on the plan, y down (imports/homes/home.h). Out: metres, z up, y turned
// round so that the system is right-handed.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "imports/homes/home.h"
#include "scenes/tessellation.h"

namespace regather::imports {

using scenes::Surface;
using trace::Vec3;

/// A place of the plan, `elevation` above its ground, in the scene [m].
Vec3 in_metres(PlanPoint p, double elevation);

/// The two long sides of a wall as seen from above, each from its start to its end; `left` is on the left
/// hand of somebody who walks from start to end. Straight walls have two points a side; arcs have more.
struct WallOutline {
    std::vector<PlanPoint> left, right;
};

/// One a wall, in their order. The sides of joined walls are lengthened or cut to where they meet, as long as
/// that is no farther than twice the thicker wall's thickness.
std::vector<WallOutline> wall_outlines(std::span<const HomeWall> walls);

/// What is cut out: all of a wall that `footprint` crosses by a quarter of its thickness or more, between two
/// elevations above the wall's foot [cm]. Of a wall that runs along the footprint's first edge, all that
/// `touch` touches at all, if there is one.
struct WallHole {
    std::array<PlanPoint, 4> footprint;
    double low = 0, high = 0;
    std::optional<std::array<PlanPoint, 4>> touch{};
};

/// Each part of the wall's faces by the colour it has. Together they are closed: every edge has two faces, or
/// four where two pieces touch. `left` has the reveals and ends, too.
struct WallSurfaces {
    Surface left, right, top;
};

/// `elevation` of the wall's foot [cm].
WallSurfaces extrude(const HomeWall& wall, const WallOutline& outline, double elevation,
                     std::span<const WallHole> holes);

}  // namespace regather::imports
