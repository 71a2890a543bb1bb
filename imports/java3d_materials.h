// imports/java3d_materials.h -- the materials that OBJ models of Java 3D programs may name without a
// library of their own: the table of Java 3D's OBJ loader (DefaultMaterials), which Sweet Home 3D's models
// rely on.
#pragma once
#include <string_view>

#include "scenes/mesh_material.h"

namespace regather::imports {

using scenes::MtlTerms;

/// Null for a name that is not in the table.
const MtlTerms* java3d_material(std::string_view name);

}  // namespace regather::imports
