// scenes/mesh_material.h -- materials of mesh files (meshes/material.h) as materials of a scene.
// docs/scene_format.md states the same rules.
#pragma once
#include <string>

#include "meshes/material.h"
#include "scenes/scene.h"

namespace regather::scenes {

using meshes::MetallicRoughness;
using meshes::MtlTerms;

/// d < 0.5, or illum 4, 6, 7 or 9: dielectric (1.5 when ni is not above 1). illum 3 or 5 with no kd above
/// 0.1: mirror. Some ks, and ns of 1 or more: glossy, its ks clamped so that kd + ks <= 1. Else diffuse.
Material material_of(const std::string& name, const MtlTerms& terms);

/// transmission or 1 - alpha above 0.5: dielectric. A metal (>= 0.5) of roughness below 0.1: mirror.
/// Roughness below 0.9 or a metal: glossy, with a specular of 0.04 (1 - metallic) + base_color metallic and
/// the exponent 2 / roughness^4 - 2. Else diffuse.
Material material_of(const std::string& name, const MetallicRoughness& terms);

/// By the rules of its terms.
Material material_of(const meshes::Material& material);

}  // namespace regather::scenes
