// meshes/gltf_keys.h -- what the objects of a glTF file say by keys that are no keys of glTF (Khronos Group,
// "glTF 2.0 Specification", section 5), misspelt ones among them, and by extensions that are not read.
#pragma once
#include "meshes/gltf_file.h"
#include "meshes/notes.h"

namespace regather::meshes {

/// A line for each such key of the objects that are read: the file itself, its asset, scenes, nodes, meshes
/// and their primitives, materials, accessors, bufferViews and buffers. Throws trace::DataError for an
/// element of those lists that is no object.
void note_unknown_keys(const GltfFile& file, Notes& notes);

}  // namespace regather::meshes
