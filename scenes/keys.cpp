#include "scenes/keys.h"

namespace regather::scenes {

namespace {

constexpr bool required = true, optional = false;

constexpr std::string_view point = "three coordinates [m], each from -1e12 to 1e12";
constexpr std::string_view edge = "a vector of three lengths [m], not all zero, each from -1e6 to 1e6";
constexpr std::string_view reflectance = "three reflectances (red, green, blue), each from 0 to 1";
constexpr std::string_view material = "the name of a material";
constexpr std::string_view degrees = "an angle in degrees, from -360 to 360";
constexpr std::string_view direction = "a direction of three numbers, not all zero, each from -1e6 to 1e6";
constexpr std::string_view positive_length = "a length [m], above 0 and at most 1e6";
constexpr std::string_view segments = "a whole number of segments, from 3 to 4096";
constexpr std::string_view radiance = "three radiances [W/(m^2 sr)], each from 0 to 1e12, not all zero";
constexpr std::string_view power = "three powers [W], each from 0 to 1e12, not all zero";
constexpr std::string_view mesh_file =
    "the name of an .obj, .ply, .gltf or .glb file, relative to the scene file";
constexpr std::string_view seed = "a whole number, from 0 to 4294967295";
constexpr std::string_view scale = "a factor, above 0 and at most 1e6";
constexpr std::string_view up_axis = "\"y\" or \"z\"";

}  // namespace

const Kind& scene_kind() {
    static const Kind kind{"scene",
                           {{"name", required, "a name of 1 to 64 letters, digits, '_', '-' or '.'"},
                            {"camera", required, "an object"},
                            {"camera_path", optional, "an object"},
                            {"origin", optional, "a text of at most 2000 bytes"},
                            {"licence", optional, "a text of at most 2000 bytes"},
                            {"materials", optional, "an object of materials by name"},
                            {"objects", optional, "an object of lists of shapes by name"},
                            {"shapes", optional, "a list of shapes"},
                            {"lights", optional, "a list of lights"}}};
    return kind;
}

const Kind& camera_kind() {
    static const Kind kind{
        "camera",
        {{"position", required, point},
         {"target", required, point},
         {"up", required, direction},
         {"vertical_fov_degrees", required, "an angle in degrees, above 0 and below 180"}}};
    return kind;
}

const Kind& camera_path_kind() {
    static const Kind kind{"camera path",
                           {{"frames", required, "a whole number of frames, from 2 to 1000000"},
                            {"keys", required, "a list of at least two key frames"}}};
    return kind;
}

const Kind& key_frame_kind() {
    static const Kind kind{
        "key frame",
        {{"frame", required, "a whole number, below frames and above the key frame before"},
         {"position", required, point},
         {"target", required, point},
         {"up", optional, direction}}};
    return kind;
}

std::span<const Kind> light_kinds() {
    static const std::vector<Kind> kinds{{"rectangle",
                                          {{"type", optional, "the type of a light"},
                                           {"corner", required, point},
                                           {"edge_u", required, edge},
                                           {"edge_v", required, edge},
                                           {"radiance", optional, radiance},
                                           {"power", optional, power},
                                           {"material", optional, material}}},
                                         {"sphere",
                                          {{"type", required, "the type of a light"},
                                           {"center", required, point},
                                           {"radius", required, positive_length},
                                           {"segments", required, segments},
                                           {"radiance", optional, radiance},
                                           {"power", optional, power},
                                           {"material", optional, material}}},
                                         {"mesh",
                                          {{"type", required, "the type of a light"},
                                           {"file", required, mesh_file},
                                           {"up_axis", optional, up_axis},
                                           {"scale", optional, scale},
                                           {"rotate_z_degrees", optional, degrees},
                                           {"translate", optional, point},
                                           {"radiance", optional, radiance},
                                           {"power", optional, power},
                                           {"material", optional, material}}}};
    return kinds;
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
        {"patch",
         {{"type", required, "the type of a shape"},
          {"material", required, material},
          {"corners", required, "four points [x, y, z] in metres, each coordinate from -1e12 to 1e12"},
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
          {"radius", required, positive_length},
          {"segments", required, segments}}},
        {"cylinder",
         {{"type", required, "the type of a shape"},
          {"material", required, material},
          {"from", required, point},
          {"to", required, "three coordinates [m], each from -1e12 to 1e12, another point than from"},
          {"radius", required, "a length [m], from 0 to 1e6"},
          {"radius_to", optional, "a length [m], from 0 to 1e6, above 0 when radius is 0"},
          {"segments", required, segments},
          {"smooth", optional, "true or false"}}},
        {"lathe",
         {{"type", required, "the type of a shape"},
          {"material", required, material},
          {"center", required, point},
          {"profile", required,
           "a list of 2 to 4096 points [radius, height] in metres, no point twice in a row"},
          {"segments", required, segments},
          {"smooth", optional, "true or false"}}},
        {"torus",
         {{"type", required, "the type of a shape"},
          {"material", required, material},
          {"center", required, point},
          {"axis", optional, direction},
          {"radius", required, positive_length},
          {"tube", required, "a length [m], above 0 and below radius"},
          {"segments", required, segments},
          {"tube_segments", required, segments}}},
        {"ripple",
         {{"type", required, "the type of a shape"},
          {"material", required, material},
          {"center", required, point},
          {"size", required, positive_length},
          {"amplitude", required, "a length [m], from 0 to 1e6"},
          {"wavelength", required, positive_length},
          {"phase_degrees", optional, degrees},
          {"depth", optional, "a length [m], above amplitude and at most 1e6"},
          {"cells", required, "a whole number of cells, from 1 to 4096"}}},
        {"terrain",
         {{"type", required, "the type of a shape"},
          {"material", required, material},
          {"corner", required, point},
          {"size", required, "two lengths [m], each above 0 and at most 1e6"},
          {"amplitude", required, "a length [m], from 0 to 1e6"},
          {"wavelength", required, positive_length},
          {"seed", required, seed},
          {"cells", required, "two whole numbers of cells, each from 1 to 4096"},
          {"growth", optional, "a list of what grows on the terrain"}}},
        {"tuft",
         {{"type", required, "the type of a shape"},
          {"material", required, material},
          {"center", required, point},
          {"radius", required, positive_length},
          {"blades", required, "a whole number of blades, from 1 to 1000000"},
          {"height", required, positive_length},
          {"width", required, positive_length},
          {"reach", required, positive_length},
          {"segments", required, "a whole number of segments, from 1 to 64"},
          {"seed", required, seed}}},
        {"mesh",
         {{"type", required, "the type of a shape"},
          {"file", required, mesh_file},
          {"material", optional, material},
          {"materials", optional,
           "an object: name of a material in the file to name of a material of the scene"},
          {"up_axis", optional, up_axis},
          {"scale", optional, scale},
          {"rotate_z_degrees", optional, degrees},
          {"translate", optional, point}}},
        {"instances",
         {{"type", required, "the type of a shape"},
          {"object", required, "the name of an object"},
          {"at", required, "a list of places [x, y, z] or [x, y, z, degrees about the z axis]"}}}};
    return kinds;
}

const Kind& growth_kind() {
    static const Kind kind{
        "growth",
        {{"objects", required, "a list of names of objects, at least one"},
         {"count", required, "a whole number of places, from 1 to 1000000"},
         {"seed", required, seed},
         {"margin", optional, "a length [m], from 0 to less than half of the terrain's edge"},
         {"sink", optional, "a length [m], from 0 to 1e6"},
         {"scale", optional, "two factors, the least and the largest, each from 1e-6 to 1e6"},
         {"clear", optional, "a list of discs [x, y, radius] in metres"}}};
    return kind;
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

}  // namespace regather::scenes
