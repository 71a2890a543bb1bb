#include "meshes/gltf_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "trace/text.h"

namespace regather::meshes {

using trace::Field;

namespace {

constexpr std::string_view transmission = "KHR_materials_transmission", ior = "KHR_materials_ior",
                           strength = "KHR_materials_emissive_strength";

constexpr std::array<std::string_view, 3> alpha_modes{"OPAQUE", "MASK", "BLEND"};
enum AlphaMode : std::size_t { opaque, mask, blend };

constexpr NumberRange share{0, 1, "a number from 0 to 1"}, times{0, 1e30, "a number of 0 or more"};

float factor(const Field& object, std::string_view key, double otherwise, const NumberRange& range = share) {
    const auto field = object.get(key);
    return static_cast<float>(field ? field->number(range.low, range.high, range.expected) : otherwise);
}

// Of an extension's factor; `otherwise` without the extension or the factor.
float extended(const Field& material, std::string_view extension, std::string_view key, double otherwise,
               const NumberRange& range) {
    const auto extensions = material.get("extensions");
    const auto found = extensions ? extensions->get(extension) : std::nullopt;
    return found ? factor(*found, key, otherwise, range) : static_cast<float>(otherwise);
}

void note_textures(const Field& object, Notes& notes) {
    if (const auto* members = object.value().members())
        for (const auto& member : *members)
            if (member.key.ends_with("Texture")) notes.add("textures of materials are not read");
}

Material material_of(const Field& material, std::size_t number, Notes& notes) {
    Material result{.name = fmt::format("material {}", number), .terms = {}, .emission = {}};
    if (const auto name = material.get("name")) result.name = name->text();
    MetallicRoughness terms;
    if (const auto surface = material.get("pbrMetallicRoughness")) {
        const auto color = numbers_of<4>(*surface, "baseColorFactor", {1, 1, 1, 1}, share);
        terms.base_color = {static_cast<float>(color[0]), static_cast<float>(color[1]),
                            static_cast<float>(color[2])};
        terms.metallic = factor(*surface, "metallicFactor", 1);
        terms.roughness = factor(*surface, "roughnessFactor", 1);
        terms.alpha = static_cast<float>(color[3]);
        note_textures(*surface, notes);
    }
    note_textures(material, notes);
    const auto mode_field = material.get("alphaMode");
    const std::size_t mode = mode_field ? mode_field->word(alpha_modes) : opaque;
    if (mode != blend) terms.alpha = 1;
    if (mode == mask) notes.add("alpha masks of materials are not applied");
    terms.transmission = extended(material, transmission, "transmissionFactor", 0, share);
    terms.index_of_refraction = extended(material, ior, "ior", 1.5, times);
    note_extensions(material, "materials", {transmission, ior, strength}, notes);
    const auto emitted = numbers_of<3>(material, "emissiveFactor", {0, 0, 0}, share);
    const float power = extended(material, strength, "emissiveStrength", 1, times);
    result.emission =
        Vec3{static_cast<float>(emitted[0]), static_cast<float>(emitted[1]), static_cast<float>(emitted[2])} *
        power;
    if (result.emission != Vec3{}) notes.add("materials that emit light (emissiveFactor) do not shine");
    result.terms = terms;
    return result;
}

}  // namespace

std::vector<Material> read_gltf_materials(const GltfFile& file, Notes& notes) {
    std::vector<Material> materials;
    for (const Field& material : file.list("materials"))
        materials.push_back(material_of(material, materials.size(), notes));
    return materials;
}

void note_extensions(const Field& object, std::string_view nouns,
                     std::initializer_list<std::string_view> known, Notes& notes) {
    const auto extensions = object.get("extensions");
    if (!extensions) return;
    for (const auto& [name, value] : extensions->members())
        if (std::find(known.begin(), known.end(), name) == known.end())
            notes.add(fmt::format("the extension {} of {} is not read", trace::in_quotes(name), nouns));
}

}  // namespace regather::meshes
