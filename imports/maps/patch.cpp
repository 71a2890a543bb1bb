#include "imports/maps/patch.h"

#include <array>
#include <cmath>

#include "trace/vec.h"

namespace regather::imports {

using trace::Vec3d;

namespace {

// Weights of the three control points after i of n steps, times n^2 (values) or n / 2 (slopes): whole
// numbers, so that sums of floats are exact in double but for control points of very different size.
using Weights = std::array<double, 3>;
Weights value_weights(double i, double n) {
    return {(n - i) * (n - i), 2 * i * (n - i), i * i};
}
Weights slope_weights(double i, double n) {
    return {i - n, n - 2 * i, i};
}

// Outer points first: the same sum from either end.
Vec3d sum(const Weights& w, const std::array<Vec3d, 3>& p) {
    return (w[0] * p[0] + w[2] * p[2]) + w[1] * p[1];
}

struct Place {
    std::uint32_t first;  // Control point where its patch begins.
    double step;
};
Place place(std::uint32_t vertex, std::uint32_t subdivision, std::uint32_t size) {
    std::uint32_t patch = vertex / subdivision;
    if (2 * patch + 1 == size) --patch;  // The last vertex ends the last patch.
    return {2 * patch, static_cast<double>(vertex - patch * subdivision)};
}

Vec3d blend(const std::vector<Vec3>& points, std::uint32_t width, Place column, Place row,
            const Weights& across, const Weights& along) {
    std::array<Vec3d, 3> rows;
    for (std::uint32_t j = 0; j < 3; ++j) {
        const Vec3* p = &points[(row.first + j) * width + column.first];
        rows[j] = sum(across, {p[0], p[1], p[2]});
    }
    return sum(along, rows);
}

// The normal of the surface where its slopes span a plane; inside a collapsed edge they do not, a little
// further in they do.
Vec3d surface_normal(const ControlNet& net, Place column, Place row, double n) {
    const auto normal_at = [&](double i, double j) {
        const Vec3d du = blend(net.points, net.width, column, row, slope_weights(i, n), value_weights(j, n));
        const Vec3d dv = blend(net.points, net.width, column, row, value_weights(i, n), slope_weights(j, n));
        const double sizes = std::sqrt(dot(du, du) * dot(dv, dv));
        const Vec3d normal = cross(du, dv);
        const double size = length(normal);
        return size > 1e-6 * sizes && size > 0 ? (1 / size) * normal : Vec3d{};
    };
    const Vec3d normal = normal_at(column.step, row.step);
    if (dot(normal, normal) > 0) return normal;
    const auto inward = [&](double step) { return step + 0.01 * (0.5 * n - step); };
    return normal_at(inward(column.step), inward(row.step));
}

}  // namespace

std::uint64_t triangle_count(const ControlNet& net, std::uint32_t subdivision) {
    const std::uint64_t n = subdivision;
    return 2 * n * n * ((net.width - 1) / 2) * ((net.height - 1) / 2);
}

Surface tessellate(const ControlNet& net, std::uint32_t subdivision) {
    const double n = subdivision;
    const std::uint32_t columns = (net.width - 1) / 2 * subdivision + 1,
                        rows = (net.height - 1) / 2 * subdivision + 1;
    Surface surface;
    std::vector<Vec3d> normals;
    double agreement = 0;
    for (std::uint32_t v = 0; v < rows; ++v) {
        for (std::uint32_t u = 0; u < columns; ++u) {
            const Place column = place(u, subdivision, net.width), row = place(v, subdivision, net.height);
            const Weights across = value_weights(column.step, n), along = value_weights(row.step, n);
            const Vec3d p = blend(net.points, net.width, column, row, across, along);
            const double scale = n * n * n * n;
            surface.vertices.push_back(to_float(Vec3d{p.x / scale, p.y / scale, p.z / scale}));
            normals.push_back(surface_normal(net, column, row, n));
            agreement += dot(normals.back(), blend(net.normals, net.width, column, row, across, along));
        }
    }
    const double side = agreement < 0 ? -1 : 1;
    for (const Vec3d& normal : normals) surface.normals.push_back(to_float(side * normal));
    for (std::uint32_t v = 0; v + 1 < rows; ++v) {
        for (std::uint32_t u = 0; u + 1 < columns; ++u) {
            const std::uint32_t a = v * columns + u, b = a + 1, c = b + columns, d = a + columns;
            if (side > 0) {
                surface.triangles.push_back({a, b, c});
                surface.triangles.push_back({a, c, d});
            } else {
                surface.triangles.push_back({a, c, b});
                surface.triangles.push_back({a, d, c});
            }
        }
    }
    return surface;
}

}  // namespace regather::imports
