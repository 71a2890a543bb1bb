// meshes/mesh.h -- triangles and materials from OBJ, PLY, glTF and GLB files. OBJ and PLY are read by Assimp
// after a check of our own (meshes/obj.h, meshes/ply.h), glTF by meshes/gltf.h.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/tessellation.h"

namespace regather::scenes {

struct Mesh {
    Surface surface;  ///< In the file's own coordinates; the file's normals where it has them.
    std::vector<std::uint32_t> triangle_material;  ///< Index into materials.
    std::vector<Material>
        materials;  ///< The file's own, by its names; faces without one have "default", a grey of 0.5.
    std::uint64_t degenerate_faces = 0;  ///< Without area (in float coordinates), points and lines: left out.
    std::string missing_library;  ///< Of an OBJ: a material library (.mtl) that it names and that is not
                                  ///< there; else "".
};

/// Polygons are triangulated; textures are not read. Throws trace::DataError that names the file when it is
/// missing, damaged, of another kind, or has no triangle with an area. The memory used is in proportion to
/// the bytes of the file.
Mesh read_mesh(const std::filesystem::path& file);

}  // namespace regather::scenes
