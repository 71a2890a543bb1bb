#include "meshes/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "meshes/affine.h"
#include "meshes/gltf_accessor.h"
#include "meshes/gltf_file.h"
#include "meshes/gltf_keys.h"
#include "meshes/gltf_material.h"
#include "meshes/notes.h"
#include "trace/text.h"

namespace regather::meshes {

using trace::Field;
using trace::in_quotes;

namespace {

constexpr std::uint32_t none = ~0u;
enum Mode : std::uint32_t { points = 0, line_strip = 3, list_of_triangles = 4, strip = 5, fan = 6 };

class GltfReader {
public:
    explicit GltfReader(const Source& source) : file_(source, notes_), accessors_(file_) {}

    Mesh read() {
        mesh_.materials = read_gltf_materials(file_, notes_);
        walk(roots());
        note_what_is_left();
        mesh_.notes = notes_.lines();
        return std::move(mesh_);
    }

private:
    // --- nodes ---
    std::vector<std::size_t> roots() const {
        const std::vector<Field>&scenes = file_.list("scenes"), &nodes = file_.list("nodes");
        std::vector<std::size_t> roots;
        if (!scenes.empty()) {
            const auto chosen = file_.root().get("scene");
            const Field& scene = chosen ? file_.element("scenes", *chosen) : scenes.front();
            if (const auto list = scene.get("nodes"))
                for (const Field& node : list->elements()) roots.push_back(file_.index("nodes", node));
            return roots;
        }
        std::vector<bool> is_child(nodes.size());
        for (const Field& node : nodes)
            if (const auto children = node.get("children"))
                for (const Field& child : children->elements()) is_child[file_.index("nodes", child)] = true;
        for (std::size_t n = 0; n < nodes.size(); ++n)
            if (!is_child[n]) roots.push_back(n);
        return roots;
    }

    void walk(const std::vector<std::size_t>& roots) {
        struct Visit {
            std::size_t node;
            Affine place;
        };
        const std::vector<Field>& nodes = file_.list("nodes");
        std::vector<Visit> open;
        is_shown_.assign(nodes.size(), false);
        for (std::size_t i = roots.size(); i-- > 0;) open.push_back({roots[i], {}});
        while (!open.empty()) {
            const Visit visit = open.back();
            open.pop_back();
            const Field& node = nodes[visit.node];
            if (is_shown_[visit.node])
                node.fail("a node in two places or in a circle", "nodes that make trees");
            is_shown_[visit.node] = true;
            const Affine place = visit.place * place_of(node);
            if (const auto mesh = node.get("mesh")) add_mesh(node, file_.element("meshes", *mesh), place);
            if (node.has("camera")) notes_.add("cameras are not read");
            note_extensions(node, "nodes", {}, notes_);
            if (const auto children = node.get("children")) {
                const std::vector<Field> all = children->elements();
                for (std::size_t i = all.size(); i-- > 0;)
                    open.push_back({file_.index("nodes", all[i]), place});
            }
        }
    }

    // Nodes with a mesh that neither the default scene nor another one leads to, and meshes of no node.
    void note_what_no_scene_shows() {
        const std::vector<Field>& nodes = file_.list("nodes");
        std::vector<std::size_t> open;
        const auto add = [&](const std::optional<Field>& list) {
            if (!list) return;
            for (const Field& field : list->elements())
                if (const std::size_t node = file_.index("nodes", field); !is_shown_[node]) {
                    is_shown_[node] = true;
                    open.push_back(node);
                }
        };
        for (const Field& scene : file_.list("scenes")) {
            add(scene.get("nodes"));
            while (!open.empty()) {
                const Field& node = nodes[open.back()];
                open.pop_back();
                add(node.get("children"));
            }
        }
        std::uint64_t hidden = 0;
        std::vector<bool> is_placed(file_.list("meshes").size());
        for (std::size_t n = 0; n < nodes.size(); ++n)
            if (const auto mesh = nodes[n].get("mesh")) {
                is_placed[file_.index("meshes", *mesh)] = true;
                if (!is_shown_[n]) ++hidden;
            }
        notes_.add("nodes with a mesh that no scene shows are left out", hidden);
        notes_.add("meshes of no node are left out",
                   static_cast<std::uint64_t>(std::count(is_placed.begin(), is_placed.end(), false)));
    }

    static Affine place_of(const Field& node) {
        Affine place;
        if (node.has("matrix")) {
            for (const std::string_view key : {"translation", "rotation", "scale"})
                if (node.has(key)) node[key].fail(fmt::format("{} beside a matrix", key), "only one of them");
            const auto m = numbers_of<16>(node, "matrix", {});  // By columns.
            if (std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) + std::abs(m[15] - 1) > 1e-4)
                node["matrix"].fail("a last row other than 0 0 0 1", "an affine map");
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j) place.linear[3 * i + j] = m[4 * j + i];
            place.offset = {m[12], m[13], m[14]};
            return place;
        }
        const auto t = numbers_of<3>(node, "translation", {0, 0, 0});
        const auto s = numbers_of<3>(node, "scale", {1, 1, 1});
        auto q = numbers_of<4>(node, "rotation", {0, 0, 0, 1});
        const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        if (!(square > 1e-12 && square < 1e12))
            node["rotation"].fail("a quaternion without a direction", "one of length 1");
        if (std::abs(square - 1) > 1e-6)
            for (double& part : q) part /= std::sqrt(square);
        const auto [x, y, z, w] = q;
        const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                                {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                                {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) place.linear[3 * i + j] = r[i][j] * s[j];
        place.offset = {t[0], t[1], t[2]};
        return place;
    }

    // --- meshes ---
    void add_mesh(const Field& node, const Field& mesh, const Affine& place) {
        const auto skin = node.get("skin");
        const bool is_skinned = skin.has_value();
        if (skin) file_.index("skins", *skin);
        if (is_skinned) notes_.add("skins are not read: skinned meshes stand as they are bound");
        note_extensions(mesh, "meshes", {}, notes_);
        for (const Field& primitive : mesh["primitives"].elements())
            add_primitive(primitive, is_skinned ? Affine{} : place);
    }

    void note_attributes(const Field& primitive, const Field& attributes) {
        for (const auto& [name, value] : attributes.members()) {
            const std::string_view kind = std::string_view(name).substr(0, name.find('_'));
            if (kind != "POSITION" && kind != "NORMAL" && kind != "TANGENT" && kind != "TEXCOORD" &&
                kind != "JOINTS" && kind != "WEIGHTS")
                notes_.add(fmt::format("the attribute {} of vertices is not read", in_quotes(name)));
        }
        if (primitive.has("targets")) notes_.add("morph targets are not applied");
        note_extensions(primitive, "triangles", {}, notes_);
    }

    void add_primitive(const Field& primitive, const Affine& place) {
        const auto mode_field = primitive.get("mode");
        const std::uint32_t mode =
            mode_field ? mode_field->whole<std::uint32_t>(0, 6, "0 to 6") : list_of_triangles;
        if (mode <= line_strip) {
            notes_.add(mode == points ? "points are not read" : "lines are not read");
            return;
        }
        const Field attributes = primitive["attributes"];
        note_attributes(primitive, attributes);
        const auto positions = attributes.get("POSITION");
        if (!positions) {
            notes_.add("triangles without positions are left out");
            return;
        }
        const std::uint32_t material = material_of(primitive);
        const auto indices = primitive.get("indices");
        const std::uint64_t corners = accessors_.count(indices ? *indices : *positions);
        if (corners < 3) {
            notes_.add("triangles (lists, strips, fans) of fewer than three corners are left out");
            return;
        }
        if (mode == list_of_triangles && corners % 3 != 0)
            notes_.add("corners behind the last whole triangle are left out", corners % 3);
        const std::uint64_t triangles = mode == list_of_triangles ? corners / 3 : corners - 2;
        Surface& surface = mesh_.surface;
        // Nodes may share a mesh and meshes an accessor: a small file can ask for any number of them.
        if (triangles > most_triangles - surface.triangles.size())
            primitive.fail(fmt::format("more than {} triangles", most_triangles), "at most as many");

        read_vertices(*positions, attributes.get("NORMAL"));
        std::vector<std::uint32_t> order;
        if (indices) {
            order = accessors_.indices(*indices, positions_.size());
        } else {
            order.resize(corners);
            for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        }
        number_vertices(order, place);
        const bool is_mirrored = place.determinant() < 0;
        for (std::size_t t = 0; t < triangles; ++t) {
            std::array<std::size_t, 3> at{3 * t, 3 * t + 1, 3 * t + 2};
            if (mode == strip) at = t % 2 == 0 ? std::array{t, t + 1, t + 2} : std::array{t + 1, t, t + 2};
            if (mode == fan) at = {0, t + 1, t + 2};
            if (is_mirrored) std::swap(at[1], at[2]);
            surface.triangles.push_back({order[at[0]], order[at[1]], order[at[2]]});
            mesh_.triangle_material.push_back(material);
        }
    }

    // Primitives one after the other often share their vertices.
    void read_vertices(const Field& positions, const std::optional<Field>& normals) {
        const std::size_t position = file_.index("accessors", positions);
        if (position != position_accessor_) positions_ = accessors_.points(positions);
        position_accessor_ = position;
        const std::size_t normal = normals ? file_.index("accessors", *normals) : none;
        if (normals && normal != normal_accessor_) normals_ = accessors_.points(*normals);
        if (!normals) normals_.clear();
        normal_accessor_ = normal;
        if (normals && normals_.size() != positions_.size())
            normals->fail(fmt::format("{} normals", normals_.size()),
                          fmt::format("one for each of {} positions", positions_.size()));
    }

    // Appends the vertices that `order` names, at their place, and makes it name those.
    void number_vertices(std::vector<std::uint32_t>& order, const Affine& place) {
        Surface& surface = mesh_.surface;
        if (last_use_.size() < positions_.size()) last_use_.resize(positions_.size());
        ++use_;
        for (std::uint32_t& v : order) {
            auto& [use, number] = last_use_[v];
            if (use != use_) {
                use = use_;
                number = static_cast<std::uint32_t>(surface.vertices.size());
                const Vec3 p = to_float(place(positions_[v]));
                if (!trace::is_finite(p)) file_.root().fail("a vertex whose place is not finite", "numbers");
                surface.vertices.push_back(p);
                surface.normals.push_back(normals_.empty() ? Vec3{} : place.normal(normals_[v]));
            }
            v = number;
        }
    }

    std::uint32_t material_of(const Field& primitive) {
        if (const auto material = primitive.get("material"))
            return static_cast<std::uint32_t>(file_.index("materials", *material));
        if (!grey_) {
            grey_ = static_cast<std::uint32_t>(mesh_.materials.size());
            mesh_.materials.push_back({.name = "default", .terms = MtlTerms{}, .emission = {}});
        }
        return *grey_;
    }

    void note_what_is_left() {
        const std::size_t scenes = file_.list("scenes").size();
        note_what_no_scene_shows();
        notes_.add("scenes other than the default one are not read", scenes > 1 ? scenes - 1 : 0);
        notes_.add("animations are not played", file_.list("animations").size());
        note_extensions(file_.root(), "the file", {}, notes_);
        note_unknown_keys(file_, notes_);
    }

    Notes notes_;
    GltfFile file_;
    GltfAccessors accessors_;
    Mesh mesh_;
    std::optional<std::uint32_t> grey_;
    std::vector<bool> is_shown_;  // Of each node.
    std::size_t position_accessor_ = none, normal_accessor_ = none;
    std::vector<Vec3> positions_, normals_;
    std::vector<std::pair<std::uint64_t, std::uint32_t>>
        last_use_;  // Of a position: by which primitive, as which vertex.
    std::uint64_t use_ = 0;
};

}  // namespace

Mesh read_gltf(const Source& source) {
    return GltfReader(source).read();
}

}  // namespace regather::meshes
