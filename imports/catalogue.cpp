#include "imports/catalogue.h"

#include <fmt/format.h>

#include <algorithm>

#include "imports/furniture/demonstration.h"
#include "imports/homes/sweethome3d.h"
#include "imports/maps/openarena.h"
#include "imports/mesh.h"
#include "meshes/mesh.h"
#include "scenes/summary.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::imports {
namespace {

const std::filesystem::path& one_file(const Request& request) {
    if (request.files.size() != 1)
        throw trace::UsageError(fmt::format("FILE: found {} files, expected one", request.files.size()));
    return request.files.front();
}

ImportedScene import_home(const Request& request) {
    return import_sweethome3d(one_file(request), request.home);
}

ImportedScene import_glassware(const Request& request) {
    return import_furniture(request.files);
}

ImportedScene import_one_mesh(const Request& request) {
    using Up = MeshImportOptions::Up;
    const Up up = request.up == "x" ? Up::x : request.up == "y" ? Up::y : Up::z;
    return import_mesh(one_file(request), {.up = up, .size = request.size});
}

ImportedScene import_map(const Request& request) {
    return import_openarena(request.files, {.map = request.map});
}

}  // namespace

std::span<const Importer> catalogue() {
    static const std::vector<Importer> importers{
        {"sweethome3d",
         "a home of Sweet Home 3D: .sh3d file, or sweethome3d.jar with --home NAME",
         {"home"},
         {".sh3d", ".jar"},
         import_home},
        {"furniture",
         "glassware and chess on a table, from the catalogues of sweethome3d-furniture (folder or .sh3f "
         "files)",
         {},
         {".sh3f"},
         import_glassware},
        {"mesh",
         "an OBJ, PLY or glTF file, on a floor under a light; --up x|y|z, --size METRES",
         {"up", "size"},
         {meshes::endings.begin(), meshes::endings.end()},
         import_one_mesh},
        {"openarena",
         "a map of OpenArena or Quake III Arena: its .pk3 archives, with --map NAME",
         {"map"},
         {".pk3"},
         import_map},
    };
    return importers;
}

std::string_view kind_of_file(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    for (const Importer& importer : catalogue())
        if (std::find(importer.endings.begin(), importer.endings.end(), ending) != importer.endings.end())
            return importer.kind;
    return "";
}

std::string summary_of(const ImportedScene& scene) {
    return fmt::format(
        "{}: {} triangles; {} materials ({}); {} lights; {} frames\norigin   {}\nlicence  {}\n",
        trace::shown(scene.name), scene.triangle_count(), scene.materials.size(),
        scenes::kinds_of(scene.materials), scene.lights.size(), scene.frames, trace::shown(scene.origin, 300),
        trace::shown(scene.licence, 300));
}

}  // namespace regather::imports
