// meshes/mesh.h -- triangles and materials from OBJ, PLY, glTF and GLB files, each read once, by one reader.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meshes/material.h"
#include "meshes/surface.h"

namespace regather::meshes {

struct Mesh {
    Surface surface;  ///< In the file's own coordinates; the file's normals where it has them.
    std::vector<std::uint32_t> triangle_material;  ///< Index into materials.
    std::vector<Material>
        materials;  ///< The file's own, by its names; faces without one have "default", a grey of 0.5.
    std::vector<std::uint32_t> triangle_group;  ///< Of an OBJ: index into groups; else empty.
    std::vector<std::string> groups;            ///< The names after g or o; "" before the first.
    std::uint64_t degenerate_faces = 0;  ///< Faces with fewer than three corners and triangles without area
                                         ///< (in float coordinates): left out, and noted.
    std::vector<std::string> missing_libraries;  ///< Material libraries (.mtl) that an OBJ names and that are
                                                 ///< not there.
    std::vector<std::string> notes;              ///< What is in the file and not taken over, a line a kind.
};

enum class Format : std::uint8_t { obj, ply, gltf };

/// A file that another one names.
struct Neighbour {
    std::string file;  ///< For messages.
    std::string bytes;
};

/// The bytes of a mesh file and a way to those that it names.
struct Source {
    std::string_view bytes;
    std::string file;  ///< For messages.
    std::string stem;  ///< Its name without folder and extension: an OBJ's library may bear it.
    /// Whether there is a regular file of that name, relative to the mesh file.
    std::function<bool(const std::string& name)> has_beside = [](const std::string&) { return false; };
    /// One that is there. Throws trace::DataError when it cannot be read or has more than 2^30 bytes.
    std::function<Neighbour(const std::string& name)> read_beside = {};
};

/// Polygons are triangulated (meshes/polygon.h); textures are not read. Throws trace::DataError that names
/// file, place, what was found and what was expected when the source is damaged, of another format, or has no
/// triangle with an area. Memory and time are in proportion to the bytes.
Mesh parse_mesh(Format format, const Source& source);

/// Of the names of files that read_mesh() reads.
inline constexpr std::array<std::string_view, 4> endings{".obj", ".ply", ".gltf", ".glb"};

/// The format that the name's extension says, in letters of any case.
std::optional<Format> format_of(const std::filesystem::path& file);

/// A file of at most 2^30 bytes, with those that it names. Throws trace::DataError, as parse_mesh.
Mesh read_mesh(const std::filesystem::path& file);

}  // namespace regather::meshes
