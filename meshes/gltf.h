// meshes/gltf.h -- triangles and materials from glTF 2.0 files, .gltf with its buffers beside it or inlined,
// and .glb (Khronos Group, "glTF 2.0 Specification"). Read here and not by Assimp: what a file declares is
// held against the bytes that are there before anything is made, and that check is most of the reading.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "meshes/mesh.h"

namespace regather::scenes {

/// The default scene's nodes, each at its place, as one mesh; the y axis is up, as in the file. Points,
/// lines, skins, morph targets, cameras, lights and textures are left out. Throws trace::DataError that names
/// the file and what is wrong in it: accessors beyond their buffers, indices beyond the vertices, nodes in a
/// circle, extensions that it requires and we lack.
Mesh read_gltf(const std::filesystem::path& file);

}  // namespace regather::scenes
