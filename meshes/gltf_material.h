// meshes/gltf_material.h -- materials of a glTF file (Khronos Group, "glTF 2.0 Specification", section 3.9):
// factors.
#pragma once
#include <initializer_list>
#include <string_view>
#include <vector>

#include "meshes/gltf_file.h"
#include "meshes/material.h"
#include "meshes/notes.h"

namespace regather::meshes {

/// In the file's order. Read: base colour, metal, roughness, alpha of blended ones, emission; transmission,
/// index of refraction and emissive strength of the extensions KHR_materials_*. Textures and all else are
/// noted.
std::vector<Material> read_gltf_materials(const GltfFile& file, Notes& notes);

/// Notes the extensions of an object that are not among `known`. `nouns`: "nodes".
void note_extensions(const trace::Field& object, std::string_view nouns,
                     std::initializer_list<std::string_view> known, Notes& notes);

/// From `low` to `high`; `expected`: what a message says of it.
struct NumberRange {
    double low = -1e300, high = 1e300;
    std::string_view expected = "a number";
};

/// The numbers of a list of exactly `n`, finite and in `range`; `otherwise` when there is none.
template <std::size_t n>
std::array<double, n> numbers_of(const trace::Field& object, std::string_view key,
                                 std::array<double, n> otherwise, const NumberRange& range = {}) {
    const auto list = object.get(key);
    if (!list) return otherwise;
    const std::vector<trace::Field> elements = list->elements();
    if (elements.size() != n) list->fail(list->found(), "a list of " + std::to_string(n) + " numbers");
    for (std::size_t i = 0; i < n; ++i)
        otherwise[i] = elements[i].number(range.low, range.high, range.expected);
    return otherwise;
}

}  // namespace regather::meshes
