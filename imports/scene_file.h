// imports/scene_file.h -- a scene that an importer has made, and how it is written: DIR/scene.json and
// DIR/meshes/*.ply (binary little-endian, one file a material), the form that scenes/loader.h reads and
// docs/scene_format.md describes. Metres, watts, z up.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"
#include "scenes/tessellation.h"

namespace regather::imports {

using scenes::Camera;
using scenes::KeyFrame;
using scenes::Material;
using scenes::MaterialKind;
using scenes::Surface;
using trace::Vec3;

struct ImportedMesh {
    std::uint32_t material = 0;  ///< Index into ImportedScene::materials.
    Surface surface;
};

struct ImportedLight {
    enum class Shape : std::uint8_t { rectangle, sphere, mesh };
    Shape shape = Shape::rectangle;
    Vec3 corner, edge_u, edge_v;  ///< Of a rectangle; light leaves along cross(edge_u, edge_v).
    Vec3 center;                  ///< Of a sphere,
    float radius = 0;             ///< its radius [m]
    std::uint32_t segments = 16;  ///< and its triangle columns.
    Surface surface;              ///< Of a mesh; light leaves outside.
    Vec3 power, radiance;         ///< [W] and [W / (m^2 sr)]: one of the two is zero.
    std::int32_t material = -1;   ///< How the emitter reflects; -1: black.
};

struct ImportedScene {
    std::string name;             ///< 1 to 64 letters, digits, '_', '-', '.': see plain_name.
    std::string origin, licence;  ///< UTF-8, one line each.
    Camera camera;
    std::vector<KeyFrame> camera_path;  ///< Empty, or at least two with frames from 0 to frames - 1.
    std::uint32_t frames = 1;
    std::vector<Material> materials;   ///< With names that differ, plain ASCII.
    std::vector<ImportedMesh> meshes;  ///< Several may have one material; they share a file, in this order.
    std::vector<ImportedLight> lights;
    std::vector<std::string> notes;  ///< What was guessed or left out, a line each: not written, but told.

    std::uint64_t triangle_count() const;  ///< Of the meshes.
};

/// `text` with everything but letters, digits, '_', '-' and '.' as '_', at most 64 bytes; "unnamed" when it
/// is empty.
std::string plain_name(std::string_view text);

/// Throws trace::UsageError when write_scene would refuse the folder: it exists and `force` is false, or it
/// holds something else than a scene that write_scene has written. For a refusal before the work.
void check_scene_folder(const std::filesystem::path& folder, bool force);

/// Writes into a temporary folder beside `folder` and renames it: nobody sees half a scene. Triangles without
/// area are left out, meshes and mesh lights without triangles too. Throws trace::DataError for numbers that
/// are not finite, a material index or name that is wrong; std::runtime_error when the disk refuses.
void write_scene(const ImportedScene& scene, const std::filesystem::path& folder, bool force = false);

}  // namespace regather::imports
