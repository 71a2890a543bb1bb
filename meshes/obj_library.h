// meshes/obj_library.h -- which files a line `mtllib NAMES` of an OBJ names: names may hold blanks, and
// nothing says where one ends.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "meshes/mesh.h"

namespace regather::meshes {

/// `names`: what follows mtllib. Names in double quotes are as they stand. Else the whole is one name if
/// there is such a file; else a name ends with a word that ends with ".mtl", and is taken apart at its blanks
/// if that gives files that are there. Backslashes become slashes where that gives a file. What follows '#'
/// is a comment unless it is a name.
std::vector<std::string> library_names(std::string_view names, const Source& source);

}  // namespace regather::meshes
