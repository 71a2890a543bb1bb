// imports/maps/tour.h -- a camera path through a map: from one spawn point to others, by way of the places
// where items lie, along lines that a body can move along. Game units.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "imports/maps/free_space.h"
#include "scenes/scene.h"

namespace regather::imports {

using scenes::Camera;
using scenes::KeyFrame;

/// Where a player can stand, at eye height.
struct Stop {
    Vec3 eye;
    float heading_degrees = 0;  ///< Of a spawn point: 0 looks along x, 90 along y.
    bool is_spawn = false;
};

/// Whether entities of a class are spawn points, or things that players fetch.
bool is_spawn_point(std::string_view entity_class);
bool is_item(std::string_view entity_class);

/// Stops of a map, spawn points first: the eye is 50 units above the floor below the entity. Those in a solid
/// are left out, and items beyond the first 200.
std::vector<Stop> stops_of(const Bsp& bsp, const FreeSpace& space);

struct Tour {
    Camera camera;  ///< At the path's beginning, looking where its spawn point looks.
    std::vector<KeyFrame> keys;
    std::uint32_t frames = 1;
    bool walks =
        false;  ///< False: no way leads anywhere, so the camera goes forth from the spawn point, or turns.
};

/// Begins at the spawn point that shows most, among those from which as many stops can be reached as from
/// any: the one that sees most different values of `kind_of_triangle` (one a triangle of `space`), the first
/// if several do. Visits the nearest spawn point next (as one walks), and so on, for `most_length` units at
/// most; 8 units a frame, 31 frames at least. The camera looks ahead along its way. At every frame, and half
/// way between two, the camera is `clear` of walls. `stops` must hold a spawn point.
Tour plan_tour(std::span<const Stop> stops, const FreeSpace& space,
               std::span<const std::uint32_t> kind_of_triangle, double most_length);

}  // namespace regather::imports
