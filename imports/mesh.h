// imports/mesh.h -- any OBJ, PLY or glTF file as a scene: the object stands on a floor, an area light above
// it, and the camera goes round it. Its own materials are kept.
#pragma once
#include <filesystem>

#include "imports/scene_file.h"

namespace regather::imports {

struct MeshImportOptions {
    bool y_up = true;  ///< Of the file; OBJ and glTF say so by custom.
    double size = 1;   ///< [m] The largest extent of the object in the scene.
};

/// Throws trace::DataError for a file that meshes/mesh.h refuses, trace::UsageError for a size outside [1e-3,
/// 1e3].
ImportedScene import_mesh(const std::filesystem::path& file, const MeshImportOptions& options = {});

}  // namespace regather::imports
