#include "scenes/material.h"

#include <fmt/format.h>

namespace regather::scenes {

namespace {

constexpr std::string_view channel_names[] = {"red", "green", "blue"};

}  // namespace

Material read_material(const std::string& name, const Field& node) {
    const Kind& kind = node.check(material_kinds(), "kind", "material");
    Material material;
    material.name = name;
    material.diffuse = {};
    if (name.empty()) node.fail("an empty name", "a name for the material");
    if (kind.name == "glossy") material.kind = MaterialKind::glossy;
    if (kind.name == "mirror") material.kind = MaterialKind::mirror;
    if (kind.name == "dielectric") material.kind = MaterialKind::dielectric;
    if (node.has("diffuse")) material.diffuse = node["diffuse"].triple(0, 1, expected(kind, "diffuse"));
    if (node.has("specular")) material.specular = node["specular"].triple(0, 1, expected(kind, "specular"));
    if (node.has("exponent"))
        material.exponent = static_cast<float>(node["exponent"].number(1, 1e6, expected(kind, "exponent")));
    if (node.has("index_of_refraction"))
        material.index_of_refraction = static_cast<float>(
            node["index_of_refraction"].number(1, 10, expected(kind, "index_of_refraction")));
    const Vec3 sum = material.diffuse + material.specular;
    for (int channel = 0; channel < 3; ++channel)
        if (sum[channel] > 1 + 1e-6f)  // 0.7 + 0.3 in floats may round up.
            node.fail(fmt::format("diffuse + specular = {:.6g} in {}", sum[channel], channel_names[channel]),
                      "at most 1 in each channel");
    return material;
}

}  // namespace regather::scenes
