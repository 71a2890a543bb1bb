#include "imports/model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "meshes/weld.h"

namespace regather::imports {

using trace::Vec3d;

namespace {

constexpr double crease_degrees = 40;
constexpr float pane_thickness = 0.004f;  // [m] Of glass that is a sheet in the model.
constexpr double least_size = 1e-6;       // Of a model's box, as a share of its largest extent.

// A 3 x 3 matrix by rows.
using Matrix = std::array<double, 9>;

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix c{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    return c;
}

Vec3d times(const Matrix& m, Vec3d p) {
    return {m[0] * p.x + m[1] * p.y + m[2] * p.z, m[3] * p.x + m[4] * p.y + m[5] * p.z,
            m[6] * p.x + m[7] * p.y + m[8] * p.z};
}

Matrix about_x(double a) {
    return {1, 0, 0, 0, std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a)};
}
Matrix about_y(double a) {
    return {std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a)};
}
Matrix about_z(double a) {
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
    double middle(int i) const { return (min[i] + max[i]) / 2; }
    double size(int i) const { return max[i] - min[i]; }
};

ModelBox box_of(const Model& model, const Matrix& turn) {
    ModelBox box;
    for (const Model::Part& part : model.parts)
        for (const Vec3 p : part.surface.vertices) box.include(times(turn, p));
    return box;
}

// The inverse of a diagonal or rotation matrix, transposed: what normals are turned with. By cofactors.
Matrix for_normals(const Matrix& m) {
    return {m[4] * m[8] - m[5] * m[7], m[5] * m[6] - m[3] * m[8], m[3] * m[7] - m[4] * m[6],
            m[2] * m[7] - m[1] * m[8], m[0] * m[8] - m[2] * m[6], m[1] * m[6] - m[0] * m[7],
            m[1] * m[5] - m[2] * m[4], m[2] * m[3] - m[0] * m[5], m[0] * m[4] - m[1] * m[3]};
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

std::vector<Model::Part> placed(const Model& model, const Placement& placement) {
    constexpr Matrix identity{1, 0, 0, 0, 1, 0, 0, 0, 1};
    const Matrix first = placement.model_rotation.value_or(identity);
    const ModelBox box = box_of(model, first);
    const double largest = std::max({box.size(0), box.size(1), box.size(2)});
    const auto factor = [&](int axis, double size) {
        return box.size(axis) > least_size * largest ? size / box.size(axis) : 1;
    };
    const double x = factor(0, placement.width) * (placement.mirrored ? -1 : 1);
    const Matrix scale{x, 0, 0, 0, factor(1, placement.height), 0, 0, 0, factor(2, placement.depth)};
    const Matrix turn =
        product(about_y(-placement.angle), product(about_x(-placement.pitch), about_z(-placement.roll)));
    const Matrix shape = product(scale, first);
    const Matrix all = product(turn, shape);
    const Matrix normals = for_normals(all);
    const ModelBox turned = box_of(model, all);

    std::vector<Model::Part> parts = model.parts;
    for (Model::Part& part : parts) {
        for (Vec3& p : part.surface.vertices) {
            const Vec3d q = times(all, p);
            p = to_float(Vec3d{q.x - turned.middle(0) + placement.foot.x,
                               turned.middle(2) - q.z + placement.foot.y,
                               q.y - turned.min.y + placement.foot.z});
        }
        for (Vec3& n : part.surface.normals) {
            if (n == Vec3{}) continue;
            const Vec3d q = times(normals, n);
            const double size = std::hypot(q.x, q.y, q.z) * (placement.mirrored ? -1 : 1);
            n = size != 0 ? to_float(Vec3d{q.x / size, -q.z / size, q.y / size}) : Vec3{};
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
