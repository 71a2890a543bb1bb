#include "meshes/gltf_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <string_view>

#include "meshes/gltf_material.h"
#include "trace/text.h"

namespace regather::meshes {

using trace::Field;

namespace {

using Keys = std::initializer_list<std::string_view>;

constexpr std::array<std::string_view, 3> keys_of_any{"name", "extensions", "extras"};

void note_keys(const Field& object, std::string_view nouns, Keys known, Notes& notes) {
    const auto* const members = object.value().members();
    if (members == nullptr) object.fail(object.found(), "an object");
    const auto is_in = [](const auto& keys, std::string_view key) {
        return std::find(keys.begin(), keys.end(), key) != keys.end();
    };
    for (const auto& member : *members)
        if (!is_in(known, member.key) && !is_in(keys_of_any, member.key))
            notes.add(fmt::format("the key {} of {} is not known", trace::in_quotes(member.key), nouns));
}

void note_keys_of_part(const Field& object, std::string_view key, std::string_view nouns, Keys known,
                       Notes& notes) {
    if (const auto part = object.get(key)) note_keys(*part, nouns, known, notes);
}

void note_keys_of_extensions(const Field& material, Notes& notes) {
    const auto extensions = material.get("extensions");
    if (!extensions) return;
    note_keys_of_part(*extensions, "KHR_materials_transmission", "KHR_materials_transmission",
                      {"transmissionFactor", "transmissionTexture"}, notes);
    note_keys_of_part(*extensions, "KHR_materials_ior", "KHR_materials_ior", {"ior"}, notes);
    note_keys_of_part(*extensions, "KHR_materials_emissive_strength", "KHR_materials_emissive_strength",
                      {"emissiveStrength"}, notes);
}

}  // namespace

void note_unknown_keys(const GltfFile& file, Notes& notes) {
    note_keys(file.root(), "the file",
              {"asset", "scene", "scenes", "nodes", "meshes", "materials", "accessors", "bufferViews",
               "buffers", "animations", "cameras", "images", "samplers", "skins", "textures",
               "extensionsUsed", "extensionsRequired"},
              notes);
    note_keys(file.root()["asset"], "the asset", {"version", "minVersion", "generator", "copyright"}, notes);
    for (const Field& scene : file.list("scenes")) note_keys(scene, "scenes", {"nodes"}, notes);
    for (const Field& node : file.list("nodes"))
        note_keys(
            node, "nodes",
            {"mesh", "children", "matrix", "translation", "rotation", "scale", "camera", "skin", "weights"},
            notes);
    for (const Field& mesh : file.list("meshes")) {
        note_keys(mesh, "meshes", {"primitives", "weights"}, notes);
        for (const Field& primitive : mesh["primitives"].elements())
            note_keys(primitive, "primitives", {"attributes", "indices", "material", "mode", "targets"},
                      notes);
    }
    for (const Field& material : file.list("materials")) {
        note_keys(material, "materials",
                  {"pbrMetallicRoughness", "normalTexture", "occlusionTexture", "emissiveTexture",
                   "emissiveFactor", "alphaMode", "alphaCutoff", "doubleSided"},
                  notes);
        note_keys_of_part(material, "pbrMetallicRoughness", "pbrMetallicRoughness",
                          {"baseColorFactor", "baseColorTexture", "metallicFactor", "roughnessFactor",
                           "metallicRoughnessTexture"},
                          notes);
        note_keys_of_extensions(material, notes);
    }
    for (const Field& accessor : file.list("accessors")) {
        note_keys(accessor, "accessors",
                  {"bufferView", "byteOffset", "componentType", "normalized", "count", "type", "max", "min",
                   "sparse"},
                  notes);
        note_extensions(accessor, "accessors", {}, notes);
        const auto sparse = accessor.get("sparse");
        if (!sparse) continue;
        note_keys(*sparse, "sparse accessors", {"count", "indices", "values"}, notes);
        note_keys_of_part(*sparse, "indices", "sparse indices", {"bufferView", "byteOffset", "componentType"},
                          notes);
        note_keys_of_part(*sparse, "values", "sparse values", {"bufferView", "byteOffset"}, notes);
    }
    for (const Field& view : file.list("bufferViews")) {
        note_keys(view, "bufferViews", {"buffer", "byteOffset", "byteLength", "byteStride", "target"}, notes);
        note_extensions(view, "bufferViews", {}, notes);
    }
    for (const Field& buffer : file.list("buffers")) {
        note_keys(buffer, "buffers", {"uri", "byteLength"}, notes);
        note_extensions(buffer, "buffers", {}, notes);
    }
}

}  // namespace regather::meshes
