// scenes/growth.h -- objects scattered over a terrain: where each stands. Lengths in metres.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/coordinates.h"
#include "scenes/placement.h"
#include "scenes/terrain.h"

namespace regather::scenes {

/// Seen from above, a disc in which nothing grows.
struct Clearing {
    double x, y, radius;  ///< The middle, from the terrain's corner.
};

struct Growth {
    std::vector<std::string> objects;  ///< Each place has one of them, all alike likely.
    std::uint32_t count = 0, seed = 0;
    double margin = 0;                  ///< Kept from the terrain's edges.
    double sink = 0;                    ///< How far below the ground an object's height 0 lies.
    std::array<double, 2> scale{1, 1};  ///< The least and the largest.
    std::vector<Clearing> clear;
};

/// An object of growth_kind(). Refuses what is wrong in it.
Growth read_growth(const Field& node, const Terrain& terrain, const Coordinates& coordinates);

struct Place {
    std::size_t object;  ///< Index into Growth::objects.
    Placement placement;
};

/// Place `number` < count: evenly over the terrain less margin and clearings, turned any way, upright on the
/// ground. Refuses, at `node`, clearings that leave hardly any room.
Place place_of(const Growth& growth, const Terrain& terrain, std::uint32_t number, const Field& node);

}  // namespace regather::scenes
