// meshes/gltf.h -- triangles and materials of glTF 2.0 files, .gltf and .glb (Khronos Group, "glTF 2.0
// Specification").
#pragma once
#include "meshes/mesh.h"

namespace regather::meshes {

/// The nodes of the default scene (else of the first, else all that are nobody's children), each at its
/// place, as one mesh; the y axis is up, as in the file. Lists, strips and fans of triangles are read.
/// Skinned meshes stand as they are bound, where the transforms of their nodes do not count. Points, lines,
/// morph targets, cameras, lights, animations and textures are noted. Throws trace::DataError that names the
/// file, the place in its JSON and what is wrong there: accessors beyond their buffers, indices beyond the
/// vertices, nodes in a circle or in two places, extensions that it requires and we lack.
Mesh read_gltf(const Source& source);

}  // namespace regather::meshes
