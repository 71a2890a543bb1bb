// meshes/mtl.h -- material libraries of OBJ files (Wavefront, "Object Files (.obj)", appendix B2).
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "meshes/material.h"
#include "meshes/notes.h"

namespace regather::meshes {

/// Kd, Ks, Ns, Ni, d (or 1 - Tr where there is no d), illum, Ke and the file after map_Kd, of each material
/// in order; a name that is defined twice is there twice. Keywords count in letters of any case. Ka that is
/// not black, words behind the numbers of a term and all else are noted. Throws trace::DataError that names
/// file and line for a term before the first newmtl, and for terms without their numbers.
std::vector<Material> read_mtl(std::string_view bytes, const std::string& file, Notes& notes);

}  // namespace regather::meshes
