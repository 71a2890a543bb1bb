// meshes/ply.h -- PLY files (Turk, "The PLY Polygon File Format", 1994), ASCII and both binary forms.
// Vertices with their normals, faces and triangle strips (tristrips) are read; other elements and properties
// are passed over and noted.
#pragma once
#include "meshes/mesh.h"

namespace regather::meshes {

/// Elements and properties stand in any order. The header's lines end as the first does: LF, CR LF or CR; in
/// an ASCII body values are parted by blanks and line ends of any number. Throws trace::DataError that names
/// the file and the line (of a binary body the byte): the header is whole, all elements are there, and faces
/// name only vertices that exist.
Mesh read_ply(const Source& source);

}  // namespace regather::meshes
