#include "scenes/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/coordinates.h"
#include "scenes/growth.h"
#include "scenes/loader.h"
#include "scenes/material.h"
#include "scenes/mesh_material.h"
#include "scenes/placement.h"
#include "scenes/shape.h"
#include "trace/error.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::scenes {

using meshes::Mesh;
using trace::DataError;

namespace {

constexpr double most_watts = 1e12;
constexpr double least_sine = 1e-4;  // Of the angle between view and up.
constexpr std::size_t most_text = 2000;
constexpr std::uint32_t most_frames = 1'000'000;

/// Triangles with a material each.
struct Piece {
    Surface surface;
    std::vector<std::uint32_t> material;
};

class Builder {
public:
    Builder(const std::array<double, 3>& origin, MeshStore& meshes) : coordinates_(origin), meshes_(meshes) {}

    BuiltScene build(const Field& root) {
        const Kind& kind = scene_kind();
        root.check(kind);
        read_name(root["name"]);
        for (const auto& [key, text] :
             {std::pair{"origin", &Scene::origin}, std::pair{"licence", &Scene::licence}})
            if (root.has(key)) {
                scene_.*text = root[key].text(expected(kind, key));
                if ((scene_.*text).size() > most_text)
                    root[key].fail(fmt::format("{} bytes", (scene_.*text).size()), expected(kind, key));
            }
        read_camera(root["camera"]);
        if (root.has("camera_path")) read_camera_path(root["camera_path"]);
        if (root.has("materials"))
            for (const auto& [name, node] : root["materials"].members(expected(kind, "materials"))) {
                materials_[name] = static_cast<std::uint32_t>(scene_.materials.size());
                scene_.materials.push_back(read_material(name, node));
            }
        if (root.has("objects"))
            for (const auto& [name, node] : root["objects"].members(expected(kind, "objects")))
                read_object(name, node);
        if (root.has("shapes"))
            for (const Field& node : root["shapes"].elements(expected(kind, "shapes"))) add_shape(node);
        if (root.has("lights"))
            for (const Field& node : root["lights"].elements(expected(kind, "lights"))) add_light(node);
        if (scene_.triangles.empty()) root.fail("neither shapes nor lights", "at least one of them");
        scene_.recentred_by = coordinates_.origin();
        return {std::move(scene_), std::move(flat_shape_)};
    }

private:
    // --- name, camera and its path ---
    void read_name(const Field& node) {
        const std::string_view wanted = expected(scene_kind(), "name");
        const std::string& name = node.text(wanted);
        const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                   c == '-' || c == '.';
        });
        if (name.empty() || name.size() > 64 || !plain) node.fail(trace::in_quotes(name), wanted);
        scene_.name = name;
    }

    // `eye`: "the camera".
    static void check_view(const Field& node, const Kind& kind, Vec3 up, std::string_view eye) {
        const auto from = Coordinates::absolute(node, kind, "position"),
                   to = Coordinates::absolute(node, kind, "target");
        const Vec3 view{static_cast<float>(to[0] - from[0]), static_cast<float>(to[1] - from[1]),
                        static_cast<float>(to[2] - from[2])};
        if (view == Vec3{})
            node["target"].fail(fmt::format("{}'s position", eye), "a target apart from the position");
        const float sine = length(cross(normalize(view), normalize(up)));
        if (!(sine > least_sine))
            (node.has("up") ? node["up"] : node)
                .fail("a direction parallel to the view", "one at an angle to target - position");
    }

    void read_camera(const Field& node) {
        const Kind& kind = camera_kind();
        node.check(kind);
        Camera& camera = scene_.camera;
        camera.position = coordinates_.point(node, kind, "position");
        camera.target = coordinates_.point(node, kind, "target");
        camera.up = Coordinates::vector(node, kind, "up");
        camera.vertical_fov_degrees = static_cast<float>(node["vertical_fov_degrees"].number(
            0, 180, expected(kind, "vertical_fov_degrees"), Field::Ends::open));
        check_view(node, kind, camera.up, "the camera");
    }

    void read_camera_path(const Field& node) {
        const Kind& kind = camera_path_kind();
        node.check(kind);
        const std::string_view wanted = expected(kind, "keys");
        scene_.frames = node["frames"].whole(2, most_frames, expected(kind, "frames"));
        const std::vector<Field> keys = node["keys"].elements(wanted);
        if (keys.size() < 2) node["keys"].fail(fmt::format("a list of {}", keys.size()), wanted);
        for (const Field& key : keys) {
            const Kind& key_kind = key_frame_kind();
            key.check(key_kind);
            KeyFrame frame;
            frame.frame = key["frame"].whole(0, scene_.frames - 1, expected(key_kind, "frame"));
            const bool is_first = scene_.camera_path.empty();
            if (is_first && frame.frame != 0)
                key["frame"].fail(fmt::format("{}", frame.frame), "0 in the first key frame");
            if (!is_first && frame.frame <= scene_.camera_path.back().frame)
                key["frame"].fail(fmt::format("{} after {}", frame.frame, scene_.camera_path.back().frame),
                                  expected(key_kind, "frame"));
            frame.position = coordinates_.point(key, key_kind, "position");
            frame.target = coordinates_.point(key, key_kind, "target");
            if (key.has("up")) frame.up = Coordinates::vector(key, key_kind, "up");
            check_view(key, key_kind, frame.up, "the key frame");
            scene_.camera_path.push_back(frame);
        }
        if (scene_.camera_path.back().frame != scene_.frames - 1)
            keys.back()["frame"].fail(
                fmt::format("{}", scene_.camera_path.back().frame),
                fmt::format("{}, the last frame, in the last key frame", scene_.frames - 1));
    }

    // --- materials ---
    std::uint32_t material_named(const std::string& name, const Field& node) const {
        const auto found = materials_.find(name);
        if (found != materials_.end()) return found->second;
        std::vector<std::string_view> names;
        for (const auto& [known, index] : materials_) names.push_back(known);
        if (names.empty()) node.fail(trace::in_quotes(name), "a material, and the scene has none");
        node.fail("unknown material " + trace::in_quotes(name),
                  trace::alternatives(trace::nearest_words(name, names)));
    }

    std::uint32_t material_of(const Field& node, const Kind& kind) const {
        return material_named(node["material"].text(expected(kind, "material")), node["material"]);
    }

    // The reflectance of a light that names none.
    std::uint32_t black() {
        if (!black_) {
            black_ = static_cast<std::uint32_t>(scene_.materials.size());
            scene_.materials.push_back({.name = "(emitter)", .diffuse = {}});
        }
        return *black_;
    }

    // Which of the scene's materials each of the mesh's own is.
    std::vector<std::uint32_t> own_materials(const Field& node, const Kind& kind, const std::string& file,
                                             const Mesh& mesh) {
        constexpr std::uint32_t none = ~0u;
        std::vector<std::uint32_t> chosen(mesh.materials.size(), none);
        if (node.has("materials"))
            for (const auto& [name, value] : node["materials"].members(expected(kind, "materials"))) {
                const std::uint32_t material = material_named(value.text(expected(kind, "materials")), value);
                bool is_there = false;
                for (std::size_t m = 0; m < mesh.materials.size(); ++m)
                    if (mesh.materials[m].name == name) {
                        chosen[m] = material;
                        is_there = true;
                    }
                if (!is_there) {
                    std::vector<std::string_view> names;
                    for (const meshes::Material& m : mesh.materials) names.push_back(m.name);
                    value.fail(
                        fmt::format("{}, no material of {}", trace::in_quotes(name), trace::in_quotes(file)),
                        trace::alternatives(trace::nearest_words(name, names)));
                }
            }
        std::vector<std::uint32_t>& own = own_materials_[file];
        own.resize(mesh.materials.size(), none);
        for (const std::uint32_t m : mesh.triangle_material) {
            if (chosen[m] != none) continue;
            if (!mesh.missing_libraries.empty() && !mesh.materials[m].is_described)
                node["file"].fail(
                    fmt::format("no material library {}", trace::in_quotes(mesh.missing_libraries.front())),
                    "that file, or a \"material\" for all faces");
            if (own[m] == none) {
                own[m] = static_cast<std::uint32_t>(scene_.materials.size());
                scene_.materials.push_back(scenes::material_of(mesh.materials[m]));
            }
            chosen[m] = own[m];
        }
        return chosen;
    }

    // --- shapes ---
    // Kept and not thrown: near another origin the shape may have its area.
    void note_flat(const Field& node, std::string_view found, std::string_view expected) {
        if (flat_shape_) return;
        try {
            node.fail(found, expected);
        } catch (const DataError& error) {
            flat_shape_ = error.what();
        }
    }

    void require_room_for(const Field& node, std::uint64_t triangles) const {
        if (triangles > most_triangles || triangles > most_triangles - scene_.triangles.size())
            node.fail(
                fmt::format("{} triangles after {} of the shapes before", triangles, scene_.triangles.size()),
                fmt::format("at most {} in a scene", most_triangles));
    }

    Surface made(const Field& node, const Kind& kind, const Coordinates& coordinates) {
        const Shape shape = read_shape(node, kind, coordinates);
        require_room_for(node, triangle_count(shape));
        Surface surface = tessellate(shape);
        const std::uint64_t lost = degenerate_count(surface);
        if (lost > 0)
            note_flat(node,
                      fmt::format("{} of {} triangles without area in 32-bit floats", lost,
                                  surface.triangles.size()),
                      "a larger or less divided shape, or one nearer to the others");
        return surface;
    }

    const Mesh& mesh_of(const Field& node, const Kind& kind) {
        const std::string& name = node["file"].text(expected(kind, "file"));
        try {
            return meshes_.get(name);
        } catch (const DataError& error) {
            node["file"].fail(trace::in_quotes(name), fmt::format("a readable mesh ({})", error.what()));
        }
    }

    Piece placed_mesh(const Field& node, const Kind& kind, const Coordinates& coordinates) {
        const Mesh& mesh = mesh_of(node, kind);
        require_room_for(node, mesh.surface.triangles.size());
        Placement placement;
        if (node.has("up_axis")) {
            const std::string& axis = node["up_axis"].text(expected(kind, "up_axis"));
            if (axis != "y" && axis != "z")
                node["up_axis"].fail(trace::in_quotes(axis), expected(kind, "up_axis"));
            placement.y_is_up = axis == "y";
        }
        if (node.has("scale"))
            placement.scale =
                node["scale"].number(0, most_metres, expected(kind, "scale"), Field::Ends::open_low);
        placement.turn(Coordinates::degrees(node, kind, "rotate_z_degrees"));
        if (node.has("translate")) placement.translate = Coordinates::absolute(node, kind, "translate");
        for (std::size_t axis = 0; axis < 3; ++axis) placement.translate[axis] -= coordinates.origin()[axis];
        Piece piece{mesh.surface, mesh.triangle_material};
        placement.apply(piece.surface);
        scene_.degenerate_faces_dropped += mesh.degenerate_faces;
        if (degenerate_count(piece.surface) < piece.surface.triangles.size()) {
            scene_.degenerate_faces_dropped += drop_degenerate(piece.surface, &piece.material);
        } else {
            note_flat(node.has("scale") ? node["scale"] : node,
                      "no triangle with an area at that scale and place",
                      "a larger factor, or a place nearer to the others");
        }
        for (const Vec3 p : piece.surface.vertices)
            if (!(std::abs(p.x) <= most_coordinate && std::abs(p.y) <= most_coordinate &&
                  std::abs(p.z) <= most_coordinate))
                node["file"].fail(fmt::format("a vertex at ({}, {}, {}) m", p.x, p.y, p.z),
                                  expected(shape_kinds()[0], "corner"));
        return piece;
    }

    // Any shape but instances.
    Piece read_piece(const Field& node, const Kind& kind, const Coordinates& coordinates) {
        if (kind.name == "mesh") {
            Piece piece;
            if (node.has("material")) {
                if (node.has("materials")) node.fail("both material and materials", "at most one of them");
                const std::uint32_t material = material_of(node, kind);
                piece = placed_mesh(node, kind, coordinates);
                std::fill(piece.material.begin(), piece.material.end(), material);
            } else {
                piece = placed_mesh(node, kind, coordinates);
                const std::vector<std::uint32_t> chosen =
                    own_materials(node, kind, node["file"].text(""), mesh_of(node, kind));
                for (std::uint32_t& m : piece.material) m = chosen[m];
            }
            return piece;
        }
        const std::uint32_t material = material_of(node, kind);
        Piece piece{made(node, kind, coordinates), {}};
        piece.material.assign(piece.surface.triangles.size(), material);
        return piece;
    }

    void read_object(const std::string& name, const Field& node) {
        const Coordinates own(std::array<double, 3>{});
        std::uint64_t triangles = 0;
        std::vector<Piece>& pieces = objects_[name];
        for (const Field& shape : node.elements("a list of shapes")) {
            const Kind& kind = shape.check(shape_kinds(), "type", "shape");
            if (kind.name == "instances")
                shape["type"].fail(trace::in_quotes(kind.name), "a shape that is not made of objects");
            if (shape.has("growth")) shape["growth"].fail("growth in an object", "it in the scene's shapes");
            pieces.push_back(read_piece(shape, kind, own));
            require_room_for(shape, triangles += pieces.back().surface.triangles.size());
        }
        if (pieces.empty()) node.fail("an empty list", "at least one shape");
    }

    const std::vector<Piece>& object_named(const std::string& name, const Field& node) const {
        const auto found = objects_.find(name);
        if (found != objects_.end()) return found->second;
        std::vector<std::string_view> names;
        for (const auto& [known, pieces] : objects_) names.push_back(known);
        if (names.empty()) node.fail(trace::in_quotes(name), "an object, and the scene has none");
        node.fail("unknown object " + trace::in_quotes(name),
                  trace::alternatives(trace::nearest_words(name, names)));
    }

    void add_object(const std::vector<Piece>& pieces, const Placement& placement, const Field& place) {
        for (Piece piece : pieces) {
            require_room_for(place, piece.surface.triangles.size());
            placement.apply(piece.surface);
            if (const std::uint64_t lost = degenerate_count(piece.surface); lost > 0)
                note_flat(place, fmt::format("{} triangles without area in 32-bit floats", lost),
                          "a place nearer to the others");
            append(piece, -1);
        }
    }

    void add_instances(const Field& node, const Kind& kind) {
        const std::vector<Piece>& pieces =
            object_named(node["object"].text(expected(kind, "object")), node["object"]);
        const std::string_view wanted = expected(kind, "at");
        for (const Field& place : node["at"].elements(wanted)) {
            const std::vector<Field> values = place.elements(wanted);
            if (values.size() != 3 && values.size() != 4)
                place.fail(fmt::format("a list of {}", values.size()), wanted);
            Placement placement;
            for (std::size_t axis = 0; axis < 3; ++axis)
                placement.translate[axis] = values[axis].number(-most_coordinate, most_coordinate, wanted) -
                                            coordinates_.origin()[axis];
            if (values.size() == 4) placement.turn(values[3].number(-360, 360, wanted));
            add_object(pieces, placement, place);
        }
    }

    void add_growth(const Field& node, const Terrain& terrain) {
        const Growth growth = read_growth(node, terrain, coordinates_);
        std::vector<const std::vector<Piece>*> objects;
        for (std::size_t i = 0; const Field& name : node["objects"].elements())
            objects.push_back(&object_named(growth.objects[i++], name));
        for (std::uint32_t number = 0; number < growth.count; ++number) {
            const Place place = place_of(growth, terrain, number, node);
            add_object(*objects[place.object], place.placement, node);
        }
    }

    void add_shape(const Field& node) {
        const Kind& kind = node.check(shape_kinds(), "type", "shape");
        if (kind.name == "instances") {
            add_instances(node, kind);
        } else {
            append(read_piece(node, kind, coordinates_), -1);
        }
        if (kind.name != "terrain" || !node.has("growth")) return;
        const auto terrain = std::get<Terrain>(read_shape(node, kind, coordinates_));
        for (const Field& growth : node["growth"].elements(expected(kind, "growth")))
            add_growth(growth, terrain);
    }

    // --- lights ---
    void add_light(const Field& node) {
        const Kind& kind = node.check(light_kinds(), "type", "light", &light_kinds()[0]);
        AreaLight light;
        Piece piece;
        const std::uint32_t material = node.has("material") ? material_of(node, kind) : black();
        if (kind.name == "rectangle") {
            const Quad quad = std::get<Quad>(read_shape(node, kind, coordinates_));
            light.corner = quad.corner;
            light.edge_u = quad.edge_u;
            light.edge_v = quad.edge_v;
            piece.surface = made(node, kind, coordinates_);
        } else {
            if (kind.name == "mesh") {
                piece = placed_mesh(node, kind, coordinates_);
            } else {
                piece.surface = made(node, kind, coordinates_);
            }
            light.first_triangle = static_cast<std::uint32_t>(scene_.triangles.size());
            light.triangle_count = static_cast<std::uint32_t>(piece.surface.triangles.size());
            double area = 0;
            for (const auto& [a, b, c] : piece.surface.triangles)
                area += triangle_area(piece.surface.vertices[a], piece.surface.vertices[b],
                                      piece.surface.vertices[c]);
            light.mesh_area = static_cast<float>(area);
        }
        if (node.has("radiance") == node.has("power"))
            node.fail(node.has("power") ? "both radiance and power" : "neither radiance nor power",
                      "exactly one of them");
        const std::string_view key = node.has("power") ? "power" : "radiance";
        const Vec3 emitted = node[key].triple(0, most_watts, expected(kind, key));
        if (emitted == Vec3{}) node[key].fail("a light that emits nothing", expected(kind, key));
        light.radiance =
            key == "radiance" ? emitted : emitted * (1 / (std::numbers::pi_v<float> * light.area()));
        piece.material.assign(piece.surface.triangles.size(), material);
        append(piece, static_cast<std::int32_t>(scene_.lights.size()));
        scene_.lights.push_back(light);
    }

    void append(const Piece& piece, std::int32_t light) {
        const auto first = static_cast<std::uint32_t>(scene_.vertices.size());
        const Surface& surface = piece.surface;
        scene_.vertices.insert(scene_.vertices.end(), surface.vertices.begin(), surface.vertices.end());
        scene_.normals.insert(scene_.normals.end(), surface.normals.begin(), surface.normals.end());
        for (const auto& [a, b, c] : surface.triangles)
            scene_.triangles.push_back({first + a, first + b, first + c});
        scene_.triangle_material.insert(scene_.triangle_material.end(), piece.material.begin(),
                                        piece.material.end());
        scene_.triangle_light.resize(scene_.triangles.size(), light);
    }

    Coordinates coordinates_;
    MeshStore& meshes_;
    Scene scene_;
    std::map<std::string, std::uint32_t, std::less<>> materials_;
    std::map<std::string, std::vector<std::uint32_t>>
        own_materials_;  // By mesh file: places in scene_.materials.
    std::map<std::string, std::vector<Piece>, std::less<>> objects_;
    std::optional<std::uint32_t> black_;
    std::optional<std::string> flat_shape_;
};

}  // namespace

const Mesh& MeshStore::get(const std::string& name) {
    if (const auto found = meshes_.find(name); found != meshes_.end()) return found->second;
    const Mesh& mesh = meshes_.emplace(name, meshes::read_mesh(directory_ / name)).first->second;
    for (const std::string& note : mesh.notes)
        notes_.push_back(fmt::format("{}: {}", trace::shown((directory_ / name).string(), 200), note));
    return mesh;
}

BuiltScene build_scene(const Field& root, const std::array<double, 3>& origin, MeshStore& meshes) {
    return Builder(origin, meshes).build(root);
}

}  // namespace regather::scenes
