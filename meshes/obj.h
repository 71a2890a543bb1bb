// meshes/obj.h -- OBJ files with their material libraries (Wavefront, "Object Files (.obj)", appendix B1).
// Polygons, normals, groups and materials are read; points, lines, curves, surfaces, colours and weights of
// vertices are noted.
#pragma once
#include "meshes/mesh.h"

namespace regather::meshes {

/// The faces in the file's order. Throws trace::DataError that names file and line: vertices and normals have
/// finite numbers, faces name only vertices, texture coordinates and normals that the file has.
///
/// Libraries: names after mtllib are quoted, or end with ".mtl" or the line, so that they may hold blanks.
/// One that is not there is looked for under the OBJ's own name; failing that it stands in
/// Mesh::missing_libraries.
Mesh read_obj(const Source& source);

}  // namespace regather::meshes
