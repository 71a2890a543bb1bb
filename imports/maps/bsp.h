// imports/maps/bsp.h -- maps of Quake III Arena and OpenArena: IBSP version 46, values only. The layout
// follows the engine's published source (qfiles.h) and K. Proudfoot, "Unofficial Quake 3 Map Specs" (2000).
// Lengths in game units as in the file, z up; light maps, light volumes and visibility are not read. Every
// count, offset and index is checked here: what read_bsp returns can be used without further checks.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "imports/left_out.h"
#include "trace/vec.h"

namespace regather::imports {

using trace::Vec3;

/// A texture name as faces and brushes use it, and what the map compiler noted of its shader script.
struct BspTexture {
    std::string
        name;  ///< "textures/e7/e7bricks01": the name of a shader script, or a file without its ending.
    std::uint32_t surface_flags = 0, contents = 0;

    enum : std::uint32_t { sky = 0x4, hint = 0x100, nodraw = 0x80, skip = 0x200, nolightmap = 0x400 };
    enum : std::uint32_t {
        solid = 0x1,
        lava = 0x8,
        slime = 0x10,
        water = 0x20,
        fog = 0x40,
        player_clip = 0x10000
    };
};

struct BspPlane {
    Vec3 normal;  ///< Of unit length, about.
    float distance = 0;
};

/// Children: n >= 0 is node n (always a later one, and of one parent only), n < 0 is leaf -(n + 1).
struct BspNode {
    std::uint32_t plane = 0;
    std::array<std::int32_t, 2> children{};  ///< In front of the plane, behind it.
};

struct BspLeaf {
    std::int32_t cluster = 0;                        ///< Below 0: inside a wall, or outside the map.
    std::uint32_t first_brush = 0, brush_count = 0;  ///< In Bsp::leaf_brushes.
};

/// The world (the first), or a moving part: a door, a platform, a trigger.
struct BspModel {
    std::uint32_t first_face = 0, face_count = 0;
};

/// A convex solid: the points behind all its planes.
struct BspBrush {
    std::uint32_t first_side = 0, side_count = 0;  ///< In Bsp::side_planes.
    std::uint32_t texture = 0;                     ///< Its contents are the brush's.
};

struct BspVertex {
    Vec3 position, normal;
    std::array<std::uint8_t, 4> colour{};  ///< RGBA, as the map compiler lit it.
};

struct BspFace {
    enum class Kind : std::uint8_t { polygon = 1, patch = 2, mesh = 3, billboard = 4 };
    Kind kind = Kind::polygon;
    std::uint32_t texture = 0;
    std::uint32_t first_vertex = 0, vertex_count = 0;
    std::uint32_t first_index = 0,
                  index_count = 0;  ///< Of a polygon or mesh: three a triangle, below vertex_count.
    std::uint32_t patch_width = 0,
                  patch_height = 0;  ///< Of a patch: odd, 3 to 129; their product is vertex_count.
};

/// Keys and values in the order of the file.
struct BspEntity {
    std::vector<std::pair<std::string, std::string>> pairs;

    std::string_view value(std::string_view key) const;  ///< "" when it has none.
};

struct Bsp {
    std::vector<BspEntity> entities;
    std::vector<BspTexture> textures;
    std::vector<BspPlane> planes;
    std::vector<BspNode> nodes;  ///< The first is the root; none for a map of one leaf.
    std::vector<BspLeaf> leaves;
    std::vector<std::uint32_t> leaf_brushes;
    std::vector<BspModel> models;
    std::vector<BspBrush> brushes;
    std::vector<std::uint32_t> side_planes;
    std::vector<BspVertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<BspFace> faces;
    LeftOut left_out;  ///< Lumps that are not read.
};

/// `name` stands for the file in errors. Throws trace::DataError when the bytes are no whole IBSP 46 file,
/// two lumps share bytes, an index leads nowhere, a number is not finite or beyond a million units, its faces
/// use more than ten million indices and control points together, or its entities have more than 16 MiB of
/// text.
Bsp read_bsp(std::span<const std::uint8_t> bytes, std::string_view name);

/// Entities of the text form { "key" "value" ... } .... DataError names the line.
std::vector<BspEntity> read_entities(std::string_view text, std::string_view name);

}  // namespace regather::imports
