#include "scenes/mesh_material.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace regather::scenes {

namespace {

// Not finite counts as 0.
float clamped(float x, float low, float high) {
    return std::isfinite(x) ? std::clamp(x, low, high) : low;
}
Vec3 clamped(Vec3 v) {
    return {clamped(v.x, 0, 1), clamped(v.y, 0, 1), clamped(v.z, 0, 1)};
}

void make_glossy(Material& material, Vec3 specular, float exponent) {
    for (int c = 0; c < 3; ++c) specular[c] = std::min(specular[c], 1 - material.diffuse[c]);
    if (max_component(specular) <= 0) return;
    material.kind = MaterialKind::glossy;
    material.specular = specular;
    material.exponent = clamped(exponent, 1, 1e6f);
}

}  // namespace

Material material_of(const std::string& name, const MtlTerms& terms) {
    Material material{.name = name, .diffuse = {}};
    const Vec3 kd = clamped(terms.kd), ks = clamped(terms.ks);
    const int illum = terms.illum;
    if (terms.d < 0.5f || illum == 4 || illum == 6 || illum == 7 || illum == 9) {
        material.kind = MaterialKind::dielectric;
        material.index_of_refraction = terms.ni > 1 ? clamped(terms.ni, 1, 10) : 1.5f;
    } else if ((illum == 3 || illum == 5) && max_component(kd) <= 0.1f && max_component(ks) > 0) {
        material.kind = MaterialKind::mirror;
        material.specular = ks;
    } else {
        material.diffuse = kd;
        if (terms.ns >= 1) make_glossy(material, ks, terms.ns);
    }
    return material;
}

Material material_of(const std::string& name, const MetallicRoughness& terms) {
    Material material{.name = name, .diffuse = {}};
    const Vec3 base = clamped(terms.base_color);
    const float metallic = clamped(terms.metallic, 0, 1), roughness = clamped(terms.roughness, 0, 1);
    if (terms.transmission > 0.5f || terms.alpha < 0.5f) {
        material.kind = MaterialKind::dielectric;
        material.index_of_refraction = clamped(terms.index_of_refraction, 1, 10);
    } else if (metallic >= 0.5f && roughness < 0.1f) {
        material.kind = MaterialKind::mirror;
        material.specular = base;
    } else {
        material.diffuse = base * (1 - metallic);
        const float dielectric = 0.04f * (1 - metallic), squared = roughness * roughness;
        const Vec3 specular = base * metallic + Vec3{dielectric, dielectric, dielectric};
        if (roughness < 0.9f || metallic >= 0.5f)
            make_glossy(material, specular, 2 / std::max(squared * squared, 1e-12f) - 2);
    }
    return material;
}

Material material_of(const meshes::Material& material) {
    return std::visit([&](const auto& terms) { return material_of(material.name, terms); }, material.terms);
}

}  // namespace regather::scenes
