#include "scenes/loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>

#include "scenes/catalogue.h"
#include "scenes/document.h"
#include "scenes/mesh.h"
#include "scenes/tessellation.h"
#include "trace/error.h"
#include "trace/word.h"

namespace regather::scenes {

using trace::DataError;
using trace::UsageError;

namespace {

constexpr double most_metres = 1e6, most_watts = 1e12;
constexpr std::uint32_t most_cells = 10'000, most_segments = 4096;
constexpr std::uintmax_t most_file_bytes = 256u << 20;
constexpr double least_sine = 1e-4;  // Of the angle between view and up.

// Scales, rotates about the z axis, then moves. Drops the triangles that lose their area and tells how many.
std::uint64_t place(Surface& surface, double scale, double rotate_z_degrees, Vec3 translate) {
    const double angle = rotate_z_degrees * std::numbers::pi / 180;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    for (Vec3& p : surface.vertices) {
        const double x = scale * p.x, y = scale * p.y;
        p = {static_cast<float>(cosine * x - sine * y + translate.x),
             static_cast<float>(sine * x + cosine * y + translate.y),
             static_cast<float>(scale * p.z + translate.z)};
    }
    for (Vec3& n : surface.normals)
        n = {static_cast<float>(cosine * n.x - sine * n.y), static_cast<float>(sine * n.x + cosine * n.y),
             n.z};
    return drop_degenerate(surface);
}

class Builder {
public:
    explicit Builder(std::filesystem::path directory) : directory_(std::move(directory)) {}

    Scene build(const Node& root) {
        root.check_object(scene_kind());
        read_name(root["name"]);
        read_camera(root["camera"]);
        if (root.has("materials"))
            for (const auto& [name, node] : root["materials"].members(expected(scene_kind(), "materials")))
                read_material(name, node);
        if (root.has("shapes"))
            for (const Node& node : root["shapes"].elements(expected(scene_kind(), "shapes")))
                read_shape(node);
        if (root.has("lights"))
            for (const Node& node : root["lights"].elements(expected(scene_kind(), "lights")))
                read_light(node);
        if (scene_.triangles.empty()) root.fail("neither shapes nor lights", "at least one of them");
        return std::move(scene_);
    }

private:
    static std::string_view expected(const Kind& kind, std::string_view key) {
        return kind.key(key).expected;
    }

    static Vec3 read_point(const Node& node, const Kind& kind, std::string_view key) {
        return node[key].triple(-most_metres, most_metres, expected(kind, key));
    }
    static Vec3 read_nonzero(const Node& node, const Kind& kind, std::string_view key) {
        const Vec3 v = read_point(node, kind, key);
        if (v == Vec3{}) node[key].fail("a vector of length 0", expected(kind, key));
        return v;
    }

    void read_name(const Node& node) {
        const std::string_view wanted = expected(scene_kind(), "name");
        const std::string& name = node.text(wanted);
        const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                   c == '-' || c == '.';
        });
        if (name.empty() || name.size() > 64 || !plain) node.fail(in_quotes(name), wanted);
        scene_.name = name;
    }

    void read_camera(const Node& node) {
        const Kind& kind = camera_kind();
        node.check_object(kind);
        Camera& camera = scene_.camera;
        camera.position = read_point(node, kind, "position");
        camera.target = read_point(node, kind, "target");
        camera.up = read_nonzero(node, kind, "up");
        camera.vertical_fov_degrees = static_cast<float>(node["vertical_fov_degrees"].number(
            0, 180, expected(kind, "vertical_fov_degrees"), Node::Ends::open));
        const Vec3 view = camera.target - camera.position;
        if (view == Vec3{}) node["target"].fail("the camera's position", "a target apart from the position");
        const float sine = length(cross(normalize(view), normalize(camera.up)));
        if (!(sine > least_sine))
            node["up"].fail("a direction parallel to the view", "one at an angle to target - position");
    }

    void read_material(const std::string& name, const Node& node) {
        const Kind& kind = node.check_object(material_kinds(), "kind", "material");
        Material material;
        material.name = name;
        material.diffuse = {};
        if (name.empty()) node.fail("an empty name", "a name for the material");
        if (kind.name == "glossy") material.kind = MaterialKind::glossy;
        if (kind.name == "mirror") material.kind = MaterialKind::mirror;
        if (kind.name == "dielectric") material.kind = MaterialKind::dielectric;
        if (node.has("diffuse")) material.diffuse = node["diffuse"].triple(0, 1, expected(kind, "diffuse"));
        if (node.has("specular"))
            material.specular = node["specular"].triple(0, 1, expected(kind, "specular"));
        if (node.has("exponent"))
            material.exponent =
                static_cast<float>(node["exponent"].number(1, 1e6, expected(kind, "exponent")));
        if (node.has("index_of_refraction"))
            material.index_of_refraction = static_cast<float>(
                node["index_of_refraction"].number(1, 10, expected(kind, "index_of_refraction")));
        const Vec3 sum = material.diffuse + material.specular;
        for (int channel = 0; channel < 3; ++channel)
            if (sum[channel] > 1 + 1e-6f)  // 0.7 + 0.3 in floats may round up.
                node.fail(
                    fmt::format("diffuse + specular = {:.6g} in {}", sum[channel], channel_names[channel]),
                    "at most 1 in each channel");
        materials_[name] = static_cast<std::uint32_t>(scene_.materials.size());
        scene_.materials.push_back(std::move(material));
    }

    std::uint32_t material_of(const Node& node, const Kind& kind) const {
        const std::string& name = node["material"].text(expected(kind, "material"));
        const auto found = materials_.find(name);
        if (found != materials_.end()) return found->second;
        std::vector<std::string_view> names;
        for (const auto& [known, index] : materials_) names.push_back(known);
        if (names.empty()) node["material"].fail(in_quotes(name), "a material, and the scene has none");
        node["material"].fail("unknown material " + in_quotes(name), trace::alternatives(trace::nearest_words(name, names)));
    }

    void read_shape(const Node& node) {
        const Kind& kind = node.check_object(shape_kinds(), "type", "shape");
        const std::uint32_t material = material_of(node, kind);
        if (kind.name == "quad") add_shape(node, read_quad(node, kind), material);
        if (kind.name == "box") add_shape(node, read_box(node, kind), material);
        if (kind.name == "sphere") add_shape(node, read_sphere(node, kind), material);
        if (kind.name == "mesh") add_mesh(node, kind, material);
    }

    static Quad read_quad(const Node& node, const Kind& kind) {
        Quad quad;
        quad.corner = read_point(node, kind, "corner");
        quad.edge_u = read_nonzero(node, kind, "edge_u");
        quad.edge_v = read_nonzero(node, kind, "edge_v");
        if (kind.name == "quad") read_divide(node, kind, quad.divide);
        // Below a millionth of edge_u x edge_v's possible area the two are parallel but for rounding.
        if (!(length(cross(normalize(quad.edge_u), normalize(quad.edge_v))) > 1e-6f))
            node["edge_v"].fail("a vector parallel to edge_u: no area", "one at an angle to edge_u");
        return quad;
    }

    static Box read_box(const Node& node, const Kind& kind) {
        Box box;
        box.min = read_point(node, kind, "min");
        box.max = read_point(node, kind, "max");
        for (int axis = 0; axis < 3; ++axis)
            if (!(box.min[axis] < box.max[axis]))
                node["max"].fail(
                    fmt::format("{} = {}, not above min's {}", "xyz"[axis], box.max[axis], box.min[axis]),
                    "a box with min < max on each axis");
        if (node.has("rotate_z_degrees"))
            box.rotate_z_degrees =
                node["rotate_z_degrees"].number(-360, 360, expected(kind, "rotate_z_degrees"));
        read_divide(node, kind, box.divide);
        return box;
    }

    static Sphere read_sphere(const Node& node, const Kind& kind) {
        Sphere sphere;
        sphere.center = read_point(node, kind, "center");
        sphere.radius = static_cast<float>(
            node["radius"].number(0, most_metres, expected(kind, "radius"), Node::Ends::open_low));
        sphere.segments = node["segments"].whole(3, most_segments, expected(kind, "segments"));
        return sphere;
    }

    template <std::size_t n>
    static void read_divide(const Node& node, const Kind& kind, std::array<std::uint32_t, n>& divide) {
        if (!node.has("divide")) return;
        const std::string_view wanted = expected(kind, "divide");
        const std::vector<Node> counts = node["divide"].elements(wanted);
        if (counts.size() != n) node["divide"].fail(fmt::format("a list of {}", counts.size()), wanted);
        for (std::size_t i = 0; i < n; ++i) divide[i] = counts[i].whole(1, most_cells, wanted);
    }

    void require_room_for(const Node& node, std::uint64_t triangles) const {
        if (triangles > most_triangles - scene_.triangles.size())
            node.fail(
                fmt::format("{} triangles after {} of the shapes before", triangles, scene_.triangles.size()),
                fmt::format("at most {} in a scene", most_triangles));
    }

    template <class Shape>
    void add_shape(const Node& node, const Shape& shape, std::uint32_t material) {
        require_room_for(node, triangle_count(shape));
        const Surface surface = tessellate(shape);
        if (const std::uint64_t lost = degenerate_count(surface))
            node.fail(fmt::format("{} of {} triangles without area in 32-bit floats", lost,
                                  surface.triangles.size()),
                      "a larger or less divided shape, or one nearer to the origin");
        append(surface, material, -1);
    }

    void add_mesh(const Node& node, const Kind& kind, std::uint32_t material) {
        const std::string& name = node["file"].text(expected(kind, "file"));
        Mesh mesh;
        try {
            mesh = read_mesh(directory_ / name);
        } catch (const DataError& error) {
            node["file"].fail(in_quotes(name), fmt::format("a readable mesh ({})", error.what()));
        }
        require_room_for(node, mesh.surface.triangles.size());
        double scale = 1, degrees = 0;
        Vec3 translate;
        if (node.has("scale"))
            scale = node["scale"].number(0, most_metres, expected(kind, "scale"), Node::Ends::open_low);
        if (node.has("rotate_z_degrees"))
            degrees = node["rotate_z_degrees"].number(-360, 360, expected(kind, "rotate_z_degrees"));
        if (node.has("translate")) translate = read_point(node, kind, "translate");
        scene_.degenerate_faces_dropped +=
            mesh.degenerate_faces + place(mesh.surface, scale, degrees, translate);
        if (mesh.surface.triangles.empty())
            node["scale"].fail("no triangle with an area at that scale", expected(kind, "scale"));
        for (const Vec3 p : mesh.surface.vertices)
            if (!(std::abs(p.x) <= most_metres && std::abs(p.y) <= most_metres &&
                  std::abs(p.z) <= most_metres))
                node["file"].fail(fmt::format("a vertex at ({}, {}, {}) m", p.x, p.y, p.z),
                                  expected(shape_kinds()[0], "corner"));
        append(mesh.surface, material, -1);
    }

    void read_light(const Node& node) {
        const Kind& kind = light_kind();
        node.check_object(kind);
        const Quad quad = read_quad(node, kind);
        AreaLight light{quad.corner, quad.edge_u, quad.edge_v, {}};
        if (node.has("radiance") == node.has("power"))
            node.fail(node.has("power") ? "both radiance and power" : "neither radiance nor power",
                      "exactly one of them");
        const std::string_view key = node.has("power") ? "power" : "radiance";
        const Vec3 emitted = node[key].triple(0, most_watts, expected(kind, key));
        if (emitted == Vec3{}) node[key].fail("a light that emits nothing", expected(kind, key));
        light.radiance =
            key == "radiance" ? emitted : emitted * (1 / (std::numbers::pi_v<float> * light.area()));
        require_room_for(node, 2);
        const std::uint32_t material = node.has("material") ? material_of(node, kind) : black();
        append(tessellate(quad), material, static_cast<std::int32_t>(scene_.lights.size()));
        scene_.lights.push_back(light);
    }

    // The reflectance of a light that names none.
    std::uint32_t black() {
        if (!black_) {
            black_ = static_cast<std::uint32_t>(scene_.materials.size());
            scene_.materials.push_back({.name = "(emitter)", .diffuse = {}});
        }
        return *black_;
    }

    void append(const Surface& surface, std::uint32_t material, std::int32_t light) {
        const auto first = static_cast<std::uint32_t>(scene_.vertices.size());
        scene_.vertices.insert(scene_.vertices.end(), surface.vertices.begin(), surface.vertices.end());
        scene_.normals.insert(scene_.normals.end(), surface.normals.begin(), surface.normals.end());
        for (const auto& [a, b, c] : surface.triangles)
            scene_.triangles.push_back({first + a, first + b, first + c});
        scene_.triangle_material.resize(scene_.triangles.size(), material);
        scene_.triangle_light.resize(scene_.triangles.size(), light);
    }

    static constexpr std::string_view channel_names[] = {"red", "green", "blue"};

    std::filesystem::path directory_;
    Scene scene_;
    std::map<std::string, std::uint32_t, std::less<>> materials_;
    std::optional<std::uint32_t> black_;
};

}  // namespace

Scene parse_scene(std::string_view text, const std::string& file, const std::filesystem::path& directory) {
    const Document document(text, file);
    return Builder(directory).build(document.root());
}

Scene load_scene(std::string_view name_or_path) {
    std::vector<std::string_view> names;
    for (const EmbeddedScene& scene : catalogue()) {
        if (scene.name == name_or_path)
            return parse_scene(scene.text, fmt::format("{} (embedded)", scene.name), std::filesystem::path{});
        names.push_back(scene.name);
    }
    const std::string file(name_or_path);
    const std::filesystem::path path(file);
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
        if (file.find('/') == std::string::npos && !path.has_extension())
            throw UsageError(fmt::format("scene: found {}, expected {} or a JSON file (embedded scenes: {})",
                                         in_quotes(file), trace::alternatives(trace::nearest_words(file, names)), trace::listed(names)));
        throw DataError(
            fmt::format("{}: found no file, expected a JSON scene or one of the embedded scenes {}", file,
                        trace::listed(names)));
    }
    if (!std::filesystem::is_regular_file(status))
        throw DataError(fmt::format("{}: found no regular file, expected a JSON scene", file));
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    if (error || bytes > most_file_bytes)
        throw DataError(fmt::format("{}: found {} bytes, expected a JSON scene of at most {}", file, bytes,
                                    most_file_bytes));
    std::ifstream stream(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream && text.empty()) throw DataError(fmt::format("{}: found a file that cannot be read", file));
    return parse_scene(text, file, path.parent_path());
}

}  // namespace regather::scenes
