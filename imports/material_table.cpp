#include "imports/material_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace regather::imports {

namespace {

constexpr float most_reflected = 0.9f;  // No paint reflects more.

}  // namespace

std::uint32_t MaterialTable::index_of(Material material) {
    for (int channel = 0; channel < 3; ++channel) {
        const float sum = material.diffuse[channel] + material.specular[channel];
        if (sum <= most_reflected) continue;
        material.diffuse[channel] *= most_reflected / sum;
        material.specular[channel] *= most_reflected / sum;
    }
    material.name = plain_name(material.name.substr(0, 40));
    const std::string value = fmt::format(
        "{} {} {} {} {} {} {} {} {} {}", material.name, static_cast<int>(material.kind), material.diffuse.x,
        material.diffuse.y, material.diffuse.z, material.specular.x, material.specular.y, material.specular.z,
        material.exponent, material.index_of_refraction);
    const auto [entry, is_new] = by_value_.emplace(value, static_cast<std::uint32_t>(materials_.size()));
    if (!is_new) return entry->second;
    if (const int uses = uses_of_name_[material.name]++; uses > 0)
        material.name += fmt::format("~{}", uses + 1);
    materials_.push_back(std::move(material));
    return entry->second;
}

Vec3 linear(Rgb8 color) {
    Vec3 light;
    for (int channel = 0; channel < 3; ++channel) {
        const double value = color[static_cast<std::size_t>(channel)] / 255.0;
        light[channel] =
            static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
    }
    return light;
}

Material painted(const std::string& name, Rgb8 color, double shininess) {
    Material material{.name = name, .diffuse = linear(color)};
    if (shininess < 0.05) return material;
    const auto specular = static_cast<float>(0.25 * shininess);
    material.kind = MaterialKind::glossy;
    material.diffuse = material.diffuse * (1 - specular);
    material.specular = {specular, specular, specular};
    material.exponent = static_cast<float>(std::max(1.0, 128 * shininess));
    return material;
}

}  // namespace regather::imports
