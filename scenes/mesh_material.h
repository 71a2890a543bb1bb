// scenes/mesh_material.h -- materials of other formats as materials of a scene. docs/scene_format.md states
// the same rules.
#pragma once
#include <string>

#include "scenes/scene.h"

namespace regather::scenes {

/// A material of an MTL library (Wavefront, "Object Files (.obj)", appendix B). What the library does not say
/// is as here.
struct MtlTerms {
    Vec3 kd{0.5f, 0.5f, 0.5f}, ks{};
    float ns = 0;  ///< Phong exponent.
    float d = 1;   ///< Opacity.
    float ni = 1;  ///< Index of refraction.
    int illum = 2;
};

/// d < 0.5, or illum 4, 6, 7 or 9: dielectric (1.5 when ni is not above 1). illum 3 or 5 with no kd above
/// 0.1: mirror. Some ks, and ns of 1 or more: glossy, its ks clamped so that kd + ks <= 1. Else diffuse.
Material material_of(const std::string& name, const MtlTerms& terms);

/// A metallic-roughness material of glTF 2.0 (section 3.9.2), factors only.
struct MetallicRoughness {
    Vec3 base_color{1, 1, 1};
    float metallic = 1, roughness = 1, alpha = 1;
    float transmission = 0;            ///< KHR_materials_transmission.
    float index_of_refraction = 1.5f;  ///< KHR_materials_ior.
};

/// transmission or 1 - alpha above 0.5: dielectric. A metal (>= 0.5) of roughness below 0.1: mirror.
/// Roughness below 0.9 or a metal: glossy, with a specular of 0.04 (1 - metallic) + base_color metallic and
/// the exponent 2 / roughness^4 - 2. Else diffuse.
Material material_of(const std::string& name, const MetallicRoughness& terms);

}  // namespace regather::scenes
