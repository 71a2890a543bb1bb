#include "scenes/shape.h"

#include <fmt/format.h>

#include <limits>

namespace regather::scenes {

namespace {

constexpr std::uint32_t most_cells = 10'000, most_segments = 4096, most_ripple_cells = 4096;
constexpr std::uint32_t most_blades = 1'000'000, most_blade_segments = 64;
constexpr double most_wavelengths = 1e6;  // Along a terrain's edge.

std::uint32_t read_segments(const Field& node, const Kind& kind, std::string_view key = "segments") {
    return node[key].whole(3, most_segments, expected(kind, key));
}

template <std::size_t n>
void read_divide(const Field& node, const Kind& kind, std::array<std::uint32_t, n>& divide) {
    if (!node.has("divide")) return;
    const std::string_view wanted = expected(kind, "divide");
    const std::vector<Field> counts = node["divide"].elements(wanted);
    if (counts.size() != n) node["divide"].fail(fmt::format("a list of {}", counts.size()), wanted);
    for (std::size_t i = 0; i < n; ++i) divide[i] = counts[i].whole(1, most_cells, wanted);
}

Quad read_quad(const Field& node, const Kind& kind, const Coordinates& coordinates) {
    Quad quad;
    quad.corner = coordinates.point(node, kind, "corner");
    quad.edge_u = Coordinates::vector(node, kind, "edge_u");
    quad.edge_v = Coordinates::vector(node, kind, "edge_v");
    if (kind.name == "quad") read_divide(node, kind, quad.divide);
    // Below a millionth of edge_u x edge_v's possible area the two are parallel but for rounding.
    if (!(length(cross(normalize(quad.edge_u), normalize(quad.edge_v))) > 1e-6f))
        node["edge_v"].fail("a vector parallel to edge_u: no area", "one at an angle to edge_u");
    return quad;
}

Patch read_patch(const Field& node, const Kind& kind, const Coordinates& coordinates) {
    Patch patch;
    const std::string_view wanted = expected(kind, "corners");
    const std::vector<Field> corners = node["corners"].elements(wanted);
    if (corners.size() != 4) node["corners"].fail(fmt::format("a list of {}", corners.size()), wanted);
    for (std::size_t i = 0; i < 4; ++i)
        patch.corners[i] =
            coordinates.to_float(corners[i].numbers(-most_coordinate, most_coordinate, wanted));
    read_divide(node, kind, patch.divide);
    return patch;
}

Box read_box(const Field& node, const Kind& kind, const Coordinates& coordinates) {
    Box box;
    const auto min = Coordinates::absolute(node, kind, "min"), max = Coordinates::absolute(node, kind, "max");
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(min[axis] < max[axis]))
            node["max"].fail(fmt::format("{} = {}, not above min's {}", "xyz"[axis], max[axis], min[axis]),
                             "a box with min < max on each axis");
    box.min = coordinates.to_float(min);
    box.max = coordinates.to_float(max);
    box.rotate_z_degrees = Coordinates::degrees(node, kind, "rotate_z_degrees");
    read_divide(node, kind, box.divide);
    return box;
}

Cylinder read_cylinder(const Field& node, const Kind& kind, const Coordinates& coordinates) {
    Cylinder cylinder;
    if (Coordinates::absolute(node, kind, "from") == Coordinates::absolute(node, kind, "to"))
        node["to"].fail("the same point as from", expected(kind, "to"));
    cylinder.from = coordinates.point(node, kind, "from");
    cylinder.to = coordinates.point(node, kind, "to");
    cylinder.radius = cylinder.radius_to = Coordinates::not_negative(node, kind, "radius");
    if (node.has("radius_to")) cylinder.radius_to = Coordinates::not_negative(node, kind, "radius_to");
    if (cylinder.radius == 0 && cylinder.radius_to == 0)
        node["radius"].fail("no radius at either end", "one above 0");
    cylinder.segments = read_segments(node, kind);
    if (node.has("smooth")) cylinder.smooth = node["smooth"].truth(expected(kind, "smooth"));
    return cylinder;
}

Lathe read_lathe(const Field& node, const Kind& kind, const Coordinates& coordinates) {
    Lathe lathe;
    lathe.center = coordinates.point(node, kind, "center");
    const std::string_view wanted = expected(kind, "profile");
    const std::vector<Field> points = node["profile"].elements(wanted);
    if (points.size() < 2 || points.size() > 4096)
        node["profile"].fail(fmt::format("a list of {}", points.size()), wanted);
    bool off_axis = false;
    for (const Field& point : points) {
        const std::vector<Field> two = point.elements(wanted);
        if (two.size() != 2) point.fail(fmt::format("a list of {}", two.size()), wanted);
        lathe.profile.push_back({static_cast<float>(two[0].number(0, most_metres, wanted)),
                                 static_cast<float>(two[1].number(-most_metres, most_metres, wanted))});
        if (lathe.profile.size() > 1 && lathe.profile.back() == lathe.profile[lathe.profile.size() - 2])
            point.fail("the point before it", wanted);
        off_axis = off_axis || lathe.profile.back()[0] > 0;
    }
    if (!off_axis) node["profile"].fail("radius 0 everywhere", "a radius above 0");
    lathe.segments = read_segments(node, kind);
    if (node.has("smooth")) lathe.smooth = node["smooth"].truth(expected(kind, "smooth"));
    return lathe;
}

Torus read_torus(const Field& node, const Kind& kind, const Coordinates& coordinates) {
    Torus torus;
    torus.center = coordinates.point(node, kind, "center");
    if (node.has("axis")) torus.axis = Coordinates::vector(node, kind, "axis");
    torus.radius = Coordinates::positive(node, kind, "radius");
    torus.tube = static_cast<float>(
        node["tube"].number(0, static_cast<double>(torus.radius), expected(kind, "tube"), Field::Ends::open));
    torus.segments = read_segments(node, kind);
    torus.tube_segments = read_segments(node, kind, "tube_segments");
    return torus;
}

Ripple read_ripple(const Field& node, const Kind& kind, const Coordinates& coordinates) {
    Ripple ripple;
    ripple.center = coordinates.point(node, kind, "center");
    ripple.size = Coordinates::positive(node, kind, "size");
    ripple.amplitude = Coordinates::not_negative(node, kind, "amplitude");
    ripple.wavelength = Coordinates::positive(node, kind, "wavelength");
    ripple.phase_degrees = Coordinates::degrees(node, kind, "phase_degrees");
    if (node.has("depth"))
        ripple.depth =
            static_cast<float>(node["depth"].number(static_cast<double>(ripple.amplitude), most_metres,
                                                    expected(kind, "depth"), Field::Ends::open_low));
    ripple.cells = node["cells"].whole(1, most_ripple_cells, expected(kind, "cells"));
    return ripple;
}

std::uint32_t read_seed(const Field& node, const Kind& kind) {
    return node["seed"].whole(0, std::numeric_limits<std::uint32_t>::max(), expected(kind, "seed"));
}

Terrain read_terrain(const Field& node, const Kind& kind, const Coordinates& coordinates) {
    Terrain terrain;
    terrain.corner = coordinates.point(node, kind, "corner");
    const std::string_view wanted = expected(kind, "size");
    const std::vector<Field> two = node["size"].elements(wanted);
    if (two.size() != 2) node["size"].fail(fmt::format("a list of {}", two.size()), wanted);
    terrain.amplitude = Coordinates::not_negative(node, kind, "amplitude");
    terrain.wavelength = Coordinates::positive(node, kind, "wavelength");
    for (std::size_t i = 0; i < 2; ++i) {
        terrain.size[i] = static_cast<float>(two[i].number(0, most_metres, wanted, Field::Ends::open_low));
        if (terrain.size[i] / static_cast<double>(terrain.wavelength) > most_wavelengths)
            node["wavelength"].fail(fmt::format("{:.6g}", terrain.wavelength),
                                    "at least a millionth of the terrain's edges");
    }
    terrain.seed = read_seed(node, kind);
    const std::vector<Field> counts = node["cells"].elements(expected(kind, "cells"));
    if (counts.size() != 2)
        node["cells"].fail(fmt::format("a list of {}", counts.size()), expected(kind, "cells"));
    for (std::size_t i = 0; i < 2; ++i)
        terrain.cells[i] = counts[i].whole(1, most_ripple_cells, expected(kind, "cells"));
    return terrain;
}

Tuft read_tuft(const Field& node, const Kind& kind, const Coordinates& coordinates) {
    Tuft tuft;
    tuft.center = coordinates.point(node, kind, "center");
    tuft.radius = Coordinates::positive(node, kind, "radius");
    tuft.blades = node["blades"].whole(1, most_blades, expected(kind, "blades"));
    tuft.height = Coordinates::positive(node, kind, "height");
    tuft.width = Coordinates::positive(node, kind, "width");
    tuft.reach = Coordinates::positive(node, kind, "reach");
    tuft.segments = node["segments"].whole(1, most_blade_segments, expected(kind, "segments"));
    tuft.seed = read_seed(node, kind);
    return tuft;
}

}  // namespace

Shape read_shape(const Field& node, const Kind& kind, const Coordinates& coordinates) {
    if (kind.name == "patch") return read_patch(node, kind, coordinates);
    if (kind.name == "box") return read_box(node, kind, coordinates);
    if (kind.name == "sphere")
        return Sphere{coordinates.point(node, kind, "center"), Coordinates::positive(node, kind, "radius"),
                      read_segments(node, kind)};
    if (kind.name == "cylinder") return read_cylinder(node, kind, coordinates);
    if (kind.name == "lathe") return read_lathe(node, kind, coordinates);
    if (kind.name == "torus") return read_torus(node, kind, coordinates);
    if (kind.name == "ripple") return read_ripple(node, kind, coordinates);
    if (kind.name == "terrain") return read_terrain(node, kind, coordinates);
    if (kind.name == "tuft") return read_tuft(node, kind, coordinates);
    return read_quad(node, kind, coordinates);
}

std::uint64_t triangle_count(const Shape& shape) {
    return std::visit([](const auto& one) { return triangle_count(one); }, shape);
}

Surface tessellate(const Shape& shape) {
    return std::visit([](const auto& one) { return tessellate(one); }, shape);
}

}  // namespace regather::scenes
