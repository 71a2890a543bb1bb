#include "imports/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "imports/model.h"
#include "imports/orbit.h"
#include "meshes/mesh.h"
#include "scenes/mesh_material.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::imports {

using meshes::Mesh;
using scenes::Quad;
using trace::DataError;
using trace::UsageError;

namespace {

constexpr float fov_degrees = 40;
constexpr std::uint32_t frames = 36;
constexpr float watts_a_square_metre = 25;  // Of floor below the object, all of it sized in proportion.

}  // namespace

ImportedScene import_mesh(const std::filesystem::path& file, const MeshImportOptions& options) {
    if (!(options.size >= 1e-3 && options.size <= 1e3))
        throw UsageError(fmt::format("--size: found {} m, expected 0.001 to 1000", options.size));
    const Mesh mesh = meshes::read_mesh(file);
    const trace::Bounds3 bounds = trace::bounds_of(mesh.surface.vertices);
    const double extent[3]{double{bounds.max.x} - bounds.min.x, double{bounds.max.y} - bounds.min.y,
                           double{bounds.max.z} - bounds.min.z};
    const double largest = std::max({extent[0], extent[1], extent[2]});
    if (!(std::isfinite(largest) && largest > 0))
        throw DataError(fmt::format("{}: found an extent of {}, expected an object of some size",
                                    file.string(), largest));

    Model model;
    for (std::uint32_t m = 0; m < mesh.materials.size(); ++m) {
        Model::Part part{scenes::material_of(mesh.materials[m]), {}};
        part.surface = triangles_with(mesh.surface, mesh.triangle_material, m);
        if (!part.surface.triangles.empty()) model.parts.push_back(std::move(part));
    }
    Placement placement;
    const double scale = options.size / largest;
    // Which axes of the file become the model's x, y (up) and z, and how it is turned to that end.
    std::array<std::size_t, 3> axes{0, 1, 2};
    if (options.up == MeshImportOptions::Up::z) {
        axes = {0, 2, 1};
        placement.model_rotation = {1, 0, 0, 0, 0, 1, 0, -1, 0};  // (x, y, z) -> (x, z, -y)
    } else if (options.up == MeshImportOptions::Up::x) {
        axes = {1, 0, 2};
        placement.model_rotation = {0, -1, 0, 1, 0, 0, 0, 0, 1};  // (x, y, z) -> (-y, x, z)
    }
    placement.width = extent[axes[0]] * scale;
    placement.height = extent[axes[1]] * scale;
    placement.depth = extent[axes[2]] * scale;

    ImportedScene scene;
    scene.name = plain_name(file.stem().string());
    scene.origin = fmt::format("{}", file.filename().string());
    scene.licence = "not stated in the file";
    for (const std::string& note : mesh.notes)
        scene.notes.push_back(fmt::format("{}: {}", trace::shown(file.string(), 200), note));
    MaterialTable table(scene.materials);
    const auto size = static_cast<float>(options.size);
    const std::uint32_t floor = table.index_of({.name = "studio_floor", .diffuse = {0.5f, 0.5f, 0.5f}});
    const float half = 6 * size;
    scene.meshes.push_back(
        {floor, tessellate(Quad{{-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0}, {8, 8}})});
    add_parts(placed(model, placement), table, scene);

    ImportedLight light;
    const float side = 0.8f * size, up = 2.5f * size;
    light.corner = {-side / 2 + 0.5f * size, -side / 2 - 0.7f * size, up};
    light.edge_u = {0, side, 0};
    light.edge_v = {side, 0, 0};
    const float watts = watts_a_square_metre * 4 * size * size;
    light.power = {watts, watts, watts};
    scene.lights.push_back(light);

    const auto height = static_cast<float>(placement.height);
    const double diagonal = std::hypot(placement.width, placement.depth, placement.height);
    Orbit orbit{.center = {0, 0, height / 2}, .from_degrees = -120, .to_degrees = 240, .frames = frames};
    orbit.distance = 0.55 * diagonal / std::tan(fov_degrees / 2 * 3.14159265358979 / 180) + 0.1 * diagonal;
    orbit.height = 0.35 * orbit.distance;
    scene.camera_path = keys_of(orbit);
    scene.frames = frames;
    scene.camera = {scene.camera_path[0].position, scene.camera_path[0].target, {0, 0, 1}, fov_degrees};
    return scene;
}

}  // namespace regather::imports
