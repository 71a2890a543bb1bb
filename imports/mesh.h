// imports/mesh.h -- any OBJ, PLY or glTF file as a scene: the object stands on a floor, an area light above
// it, and the camera goes round it. Its own materials are kept.
#pragma once
#include <cstdint>
#include <filesystem>

#include "imports/scene_file.h"

namespace regather::imports {

struct MeshImportOptions {
    enum class Up : std::uint8_t { x, y, z };
    Up up = Up::y;    ///< Which axis of the file points up; OBJ and glTF have y by custom.
    double size = 1;  ///< [m] The largest extent of the object in the scene.
};

/// Throws trace::DataError for a file that meshes/mesh.h refuses, trace::UsageError for a size outside [1e-3,
/// 1e3].
ImportedScene import_mesh(const std::filesystem::path& file, const MeshImportOptions& options = {});

}  // namespace regather::imports
