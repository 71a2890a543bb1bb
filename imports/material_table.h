// imports/material_table.h -- the materials of a scene in the making, each once, and those that a colour
// makes.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "imports/scene_file.h"

namespace regather::imports {

using Rgb8 = std::array<std::uint8_t, 3>;  ///< sRGB, red first.

/// By their values: equal ones are one.
class MaterialTable {
public:
    explicit MaterialTable(std::vector<Material>& materials) : materials_(materials) {}
    /// `material` with a name that nothing else has; no more than 0.9 of the light is reflected.
    std::uint32_t index_of(Material material);

private:
    std::vector<Material>& materials_;
    std::map<std::string, std::uint32_t> by_value_;
    std::map<std::string, int> uses_of_name_;
};

/// Linear light of an sRGB colour, in [0, 1].
Vec3 linear(Rgb8 color);

/// The material of a surface of that colour; shiny from a shininess of 0.05 on.
Material painted(const std::string& name, Rgb8 color, double shininess);

}  // namespace regather::imports
