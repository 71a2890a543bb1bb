#include "scenes/keys.h"

#include <algorithm>
#include <stdexcept>

namespace regather::scenes {

namespace {

constexpr bool required = true, optional = false;

constexpr std::string_view point = "three coordinates [m], each from -1e6 to 1e6";
constexpr std::string_view edge = "a vector of three lengths [m], not all zero, each from -1e6 to 1e6";
constexpr std::string_view reflectance = "three reflectances (red, green, blue), each from 0 to 1";
constexpr std::string_view material = "the name of a material";
constexpr std::string_view degrees = "an angle in degrees, from -360 to 360";

}  // namespace

const Kind& scene_kind() {
    static const Kind kind{"scene",
                           {{"name", required, "a name of 1 to 64 letters, digits, '_', '-' or '.'"},
                            {"camera", required, "an object"},
                            {"materials", optional, "an object of materials by name"},
                            {"shapes", optional, "a list of shapes"},
                            {"lights", optional, "a list of lights"}}};
    return kind;
}

const Kind& camera_kind() {
    static const Kind kind{
        "camera",
        {{"position", required, point},
         {"target", required, point},
         {"up", required, "a direction of three numbers, not all zero, each from -1e6 to 1e6"},
         {"vertical_fov_degrees", required, "an angle in degrees, above 0 and below 180"}}};
    return kind;
}

const Kind& light_kind() {
    static const Kind kind{
        "light",
        {{"corner", required, point},
         {"edge_u", required, edge},
         {"edge_v", required, edge},
         {"radiance", optional, "three radiances [W/(m^2 sr)], each from 0 to 1e12, not all zero"},
         {"power", optional, "three powers [W], each from 0 to 1e12, not all zero"},
         {"material", optional, material}}};
    return kind;
}

std::span<const Kind> shape_kinds() {
    static const std::vector<Kind> kinds{
        {"quad",
         {{"type", required, "the type of a shape"},
          {"material", required, material},
          {"corner", required, point},
          {"edge_u", required, edge},
          {"edge_v", required, edge},
          {"divide", optional, "two whole numbers of cells, each from 1 to 10000"}}},
        {"box",
         {{"type", required, "the type of a shape"},
          {"material", required, material},
          {"min", required, point},
          {"max", required, point},
          {"rotate_z_degrees", optional, degrees},
          {"divide", optional, "three whole numbers of cells, each from 1 to 10000"}}},
        {"sphere",
         {{"type", required, "the type of a shape"},
          {"material", required, material},
          {"center", required, point},
          {"radius", required, "a length [m], above 0 and at most 1e6"},
          {"segments", required, "a whole number of segments, from 3 to 4096"}}},
        {"mesh",
         {{"type", required, "the type of a shape"},
          {"material", required, material},
          {"file", required, "the name of an .obj or .ply file, relative to the scene file"},
          {"scale", optional, "a factor, above 0 and at most 1e6"},
          {"rotate_z_degrees", optional, degrees},
          {"translate", optional, point}}}};
    return kinds;
}

std::span<const Kind> material_kinds() {
    static const std::vector<Kind> kinds{
        {"diffuse", {{"kind", required, "the kind of a material"}, {"diffuse", required, reflectance}}},
        {"glossy",
         {{"kind", required, "the kind of a material"},
          {"diffuse", required, reflectance},
          {"specular", required, reflectance},
          {"exponent", required, "a Blinn-Phong exponent, from 1 to 1e6"}}},
        {"mirror", {{"kind", required, "the kind of a material"}, {"specular", required, reflectance}}},
        {"dielectric",
         {{"kind", required, "the kind of a material"},
          {"index_of_refraction", required, "an index of refraction, from 1 to 10"}}}};
    return kinds;
}

const Key& Kind::key(std::string_view key_name) const {
    for (const Key& key : keys)
        if (key.name == key_name) return key;
    throw std::logic_error("no key " + std::string(key_name) + " in the table of " + std::string(name));
}

}  // namespace regather::scenes
