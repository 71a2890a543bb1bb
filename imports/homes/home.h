// imports/homes/home.h -- a Sweet Home 3D home as its XML form describes it (Home.xml of a .sh3d file,
// grammar of Sweet Home 3D 5.5 and later: the comment of its class HomeXMLHandler). Lengths in centimetres,
// angles in radians; the plan's x points right and y down, elevation up. Nothing is interpreted here:
// imports/homes/sweethome3d.h makes a scene of it.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "imports/left_out.h"
#include "imports/material_table.h"
#include "meshes/polygon.h"

namespace regather::imports {

/// What a home may have, and how long, far or high anything in it may be [cm]. More is refused.
inline constexpr std::size_t most_home_items = 20'000;  ///< Walls, rooms, pieces, levels, cameras: each.
inline constexpr std::size_t most_room_points = 4'000;
inline constexpr std::size_t most_wall_openings = 100;  ///< Doors and windows that cross one wall.
inline constexpr double most_home_centimetres = 1e6;
inline constexpr int most_group_depth = 16;

using meshes::PlanPoint;

struct HomeLevel {
    std::string id;
    double elevation = 0, height = 0;
    bool viewable = true;
};

struct HomeWall {
    std::string id, at_start, at_end;  ///< Its own name, and the walls that it is joined to; empty for none.
    std::string level;
    PlanPoint start, end;
    double height = 0, height_at_end = 0, thickness = 0, arc_extent = 0;
    std::optional<Rgb8> left, right, top;
    double left_shininess = 0, right_shininess = 0;
};

struct HomeRoom {
    std::string name, level;
    std::vector<PlanPoint> points;
    std::optional<Rgb8> floor, ceiling;
    double floor_shininess = 0, ceiling_shininess = 0;
    bool floor_visible = true, ceiling_visible = true;
};

/// Colour and shininess for one material of a model, by its name there.
struct HomeMaterial {
    std::string name;
    std::optional<Rgb8> color;
    std::optional<double> shininess;
};

/// Shares of the piece's width, depth and height; the diameter is a share of the width.
struct HomeLightSource {
    double x = 0, y = 0, z = 0, diameter = 0;  ///< From the left, the front and the foot.
    Rgb8 color{255, 255, 255};
};

/// Which part of a door or window cuts walls: shares of its depth (from its back), of its width (from its
/// left) and of its height (from its top).
struct HomeOpening {
    double wall_thickness = 1, wall_distance = 0;
    double wall_width = 1, wall_left = 0;
    double wall_height = 1, wall_top = 0;
    bool on_both_sides = false;  ///< It cuts all of a wall that it touches and is parallel to.
};

struct HomePiece {
    std::string name, catalogue_id, model, level;
    double x = 0, y = 0, elevation = 0, angle = 0, pitch = 0, roll = 0, width = 0, depth = 0, height = 0;
    bool mirrored = false, visible = true;
    std::optional<std::array<double, 9>> model_rotation;  ///< By rows.
    bool model_centred = true;                            ///< After that rotation.
    std::optional<Rgb8> color;
    std::optional<double> shininess;
    std::vector<HomeMaterial> materials;
    std::optional<HomeOpening> opening;  ///< Of a door or window.
    double power = 0;                    ///< Of a light, 0 to 1.
    std::vector<HomeLightSource> light_sources;
};

struct HomeCamera {
    std::string attribute;  ///< "observerCamera", "topCamera" or "storedCamera".
    std::string name;
    double x = 0, y = 0, z = 0, yaw = 0, pitch = 0, field_of_view = 1;  ///< The field is horizontal.
};

struct Home {
    std::string name, author, copyright, licence;
    double wall_height = 250;
    std::vector<HomeLevel> levels;
    std::vector<HomeWall> walls;
    std::vector<HomeRoom> rooms;
    std::vector<HomePiece> pieces;  ///< Those of groups, too: the XML gives all of them places in the plan.
    std::vector<HomeCamera> cameras;
    LeftOut left_out;
};

/// `file` names the document in errors. DataError "FILE: line N: FIELD: found X, expected Y" for XML that is
/// damaged, a missing or senseless number, a piece without a model, a level that the home does not have.
Home read_home(std::span<const std::uint8_t> xml, const std::string& file);

}  // namespace regather::imports
