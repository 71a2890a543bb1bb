// scenes/mesh.h -- triangles from OBJ and PLY files, read by Assimp.
#pragma once
#include <cstdint>
#include <filesystem>

#include "scenes/tessellation.h"

namespace regather::scenes {

struct Mesh {
    Surface surface;  ///< In the file's own coordinates; the file's normals where it has them.
    std::uint64_t degenerate_faces = 0;  ///< Without area (in float coordinates), points and lines: left out.
};

/// Polygons are triangulated. Throws trace::DataError that names the file when it is missing, damaged,
/// neither OBJ nor PLY, or has no triangle with an area.
Mesh read_mesh(const std::filesystem::path& file);

}  // namespace regather::scenes
