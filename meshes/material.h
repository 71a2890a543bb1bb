// meshes/material.h -- what a mesh file says of a material, as it says it. What a scene makes of it:
// scenes/mesh_material.h.
#pragma once
#include <string>
#include <variant>

#include "trace/vec.h"

namespace regather::meshes {

using trace::Vec3;

/// A material of an MTL library (Wavefront, "Object Files (.obj)", appendix B). What the library does not say
/// is as here.
struct MtlTerms {
    Vec3 kd{0.5f, 0.5f, 0.5f}, ks{};
    float ns = 0;  ///< Phong exponent.
    float d = 1;   ///< Opacity.
    float ni = 1;  ///< Index of refraction.
    int illum = 2;
};

/// A metallic-roughness material of glTF 2.0 (section 3.9.2), factors only.
struct MetallicRoughness {
    Vec3 base_color{1, 1, 1};
    float metallic = 1, roughness = 1, alpha = 1;
    float transmission = 0;            ///< KHR_materials_transmission.
    float index_of_refraction = 1.5f;  ///< KHR_materials_ior.
};

struct Material {
    std::string name;
    std::variant<MtlTerms, MetallicRoughness> terms;
    Vec3 emission;             ///< Ke, or emissiveFactor times its strength, as it stands there.
    std::string texture{};     ///< The file that an MTL library gives for Kd; "" for none.
    bool is_described = true;  ///< False for a name that no library describes: `terms` are a grey of 0.5.
};

}  // namespace regather::meshes
