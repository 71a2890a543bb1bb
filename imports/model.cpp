#include "imports/model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "meshes/weld.h"

namespace regather::imports {

using meshes::cofactors, meshes::product, meshes::times, trace::Vec3d;

namespace {

constexpr double crease_degrees = 40;
constexpr float pane_thickness = 0.004f;  // [m] Of glass that is a sheet in the model.
constexpr double least_size = 1e-6;       // Of a model's box, as a share of its largest extent.

Matrix3 about_x(double a) {
    return {1, 0, 0, 0, std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a)};
}
Matrix3 about_y(double a) {
    return {std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a)};
}
Matrix3 about_z(double a) {
    return {std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1};
}

struct ModelBox {
    Vec3d min{1e300, 1e300, 1e300}, max{-1e300, -1e300, -1e300};
    void include(const Vec3d& p) {
        for (int i = 0; i < 3; ++i) {
            min[i] = std::min(min[i], p[i]);
            max[i] = std::max(max[i], p[i]);
        }
    }
    Vec3d middle() const { return (min + max) * 0.5; }
    double size(int i) const { return max[i] - min[i]; }
};

ModelBox box_of(const Model& model, const Affine& place) {
    ModelBox box;
    for (const Model::Part& part : model.parts)
        for (const Vec3 p : part.surface.vertices) box.include(place(p));
    return box;
}

}  // namespace

Surface triangles_with(const Surface& all, const std::vector<std::uint32_t>& tags, std::uint32_t tag) {
    Surface part;
    std::vector<std::uint32_t> index(all.vertices.size(), ~0u);
    for (std::size_t t = 0; t < all.triangles.size(); ++t) {
        if (tags[t] != tag) continue;
        std::array<std::uint32_t, 3> triangle{};
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t v = all.triangles[t][c];
            if (index[v] == ~0u) {
                index[v] = static_cast<std::uint32_t>(part.vertices.size());
                part.vertices.push_back(all.vertices[v]);
                part.normals.push_back(v < all.normals.size() ? all.normals[v] : Vec3{});
            }
            triangle[c] = index[v];
        }
        part.triangles.push_back(triangle);
    }
    return part;
}

std::uint64_t Model::triangles() const {
    std::uint64_t count = 0;
    for (const Part& part : parts) count += part.surface.triangles.size();
    return count;
}

Pose pose_of(const Model& model, const Placement& placement) {
    const Affine whole;
    const Affine first{
        placement.model_rotation.value_or(whole.linear),
        -times(placement.model_rotation.value_or(whole.linear), box_of(model, whole).middle())};
    const ModelBox box = box_of(model, first);
    const bool centred = placement.centred || !placement.model_rotation;
    const double largest = std::max({box.size(0), box.size(1), box.size(2)});
    const auto is_flat = [&](int axis) { return !(box.size(axis) > least_size * largest); };
    const auto factor = [&](int axis, double size) { return is_flat(axis) ? 1 : size / box.size(axis); };
    const double side = placement.mirrored ? -1 : 1;
    const Matrix3 scale{side * factor(0, placement.width), 0, 0, 0, factor(1, placement.height), 0, 0, 0,
                        factor(2, placement.depth)};
    const Matrix3 size{side * placement.width, 0, 0, 0, placement.height, 0, 0, 0, placement.depth};

    const bool leans = placement.pitch != 0 || placement.roll != 0;
    const Matrix3 lean = leans ? product(about_z(-placement.roll), about_x(-placement.pitch)) : whole.linear;
    const Matrix3 shape = product(lean, scale);
    const Affine leaning{product(shape, first.linear),
                         times(shape, first.offset - (centred ? box.middle() : Vec3d{}))};
    const ModelBox stands = box_of(model, leaning);
    Vec3d middle = leans ? stands.middle() : Vec3d{};
    middle.y = leans || (centred && !is_flat(1)) ? stands.min.y : -placement.height / 2;

    // Of the model's axes (x right, y up, z front) as the scene's: (x, -z, y).
    const Matrix3 yaw = product(Matrix3{1, 0, 0, 0, 0, -1, 0, 1, 0}, about_y(-placement.angle));
    const auto stood = [&](const Affine& a) {
        return Affine{product(yaw, a.linear), times(yaw, a.offset - middle) + placement.foot};
    };
    return {stood(leaning), stood({product(lean, size), {}})};
}

std::vector<Model::Part> placed(const Model& model, const Placement& placement) {
    const Pose pose = pose_of(model, placement);
    const Matrix3 normals = cofactors(pose.of_model.linear);

    std::vector<Model::Part> parts = model.parts;
    for (Model::Part& part : parts) {
        for (Vec3& p : part.surface.vertices) p = to_float(pose.of_model(p));
        for (Vec3& n : part.surface.normals) {
            if (n == Vec3{}) continue;
            const Vec3d q = times(normals, n);
            const double size = std::hypot(q.x, q.y, q.z) * (placement.mirrored ? -1 : 1);
            n = size != 0 ? to_float(q * (1 / size)) : Vec3{};
        }
        if (placement.mirrored)
            for (auto& triangle : part.surface.triangles) std::swap(triangle[1], triangle[2]);
    }
    return parts;
}

void add_parts(std::vector<Model::Part> parts, MaterialTable& table, ImportedScene& scene) {
    for (Model::Part& part : parts) {
        if (part.material.kind == MaterialKind::dielectric)
            part.surface = as_solid(part.surface, pane_thickness);
        const std::uint32_t material = table.index_of(std::move(part.material));
        scene.meshes.push_back({material, with_smooth_normals(part.surface, crease_degrees)});
    }
}

}  // namespace regather::imports
