#include "scenes/tessellation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace regather::scenes {

namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;

// Exact at both ends, so that neighbouring faces meet in the same floats.
float between(float from, float to, std::uint32_t i, std::uint32_t n) {
    return i == n ? to : static_cast<float>(from + (static_cast<double>(to) - from) * i / n);
}

std::uint32_t ring_count(const Sphere& sphere) {
    return std::max(2u, sphere.segments / 2);
}

}  // namespace

void add_grid_triangles(Surface& surface, std::uint32_t first, std::uint32_t nu, std::uint32_t nv) {
    for (std::uint32_t j = 0; j < nv; ++j)
        for (std::uint32_t i = 0; i < nu; ++i) {
            const std::uint32_t a = first + j * (nu + 1) + i, b = a + 1, c = b + nu + 1, d = a + nu + 1;
            surface.triangles.push_back({a, b, c});
            surface.triangles.push_back({a, c, d});
        }
}

std::uint64_t triangle_count(const Quad& quad) {
    return 2ull * quad.divide[0] * quad.divide[1];
}

std::uint64_t triangle_count(const Patch& patch) {
    return 2ull * patch.divide[0] * patch.divide[1];
}

std::uint64_t triangle_count(const Box& box) {
    const std::uint64_t x = box.divide[0], y = box.divide[1], z = box.divide[2];
    return 4 * (x * y + y * z + z * x);
}

std::uint64_t triangle_count(const Sphere& sphere) {
    return 2ull * sphere.segments * (ring_count(sphere) - 1);
}

std::uint64_t triangle_count(const Ripple& ripple) {
    const std::uint64_t n = ripple.cells;
    return 2 * n * n + (ripple.depth > 0 ? 12 * n : 0);  // Sides, and a fan for the bottom.
}

Surface tessellate(const Quad& quad) {
    Surface surface;
    const auto [nu, nv] = quad.divide;
    const Vec3 c = quad.corner, u = quad.edge_u, v = quad.edge_v;
    for (std::uint32_t j = 0; j <= nv; ++j)
        for (std::uint32_t i = 0; i <= nu; ++i) {
            const double s = static_cast<double>(i) / nu, t = static_cast<double>(j) / nv;
            surface.vertices.push_back({static_cast<float>(c.x + s * u.x + t * v.x),
                                        static_cast<float>(c.y + s * u.y + t * v.y),
                                        static_cast<float>(c.z + s * u.z + t * v.z)});
        }
    add_grid_triangles(surface, 0, nu, nv);
    surface.normals.resize(surface.vertices.size());
    return surface;
}

Surface tessellate(const Patch& patch) {
    Surface surface;
    const auto [nu, nv] = patch.divide;
    const auto& [a, b, c, d] = patch.corners;
    for (std::uint32_t j = 0; j <= nv; ++j)
        for (std::uint32_t i = 0; i <= nu; ++i) {
            Vec3 p;
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = between(between(a[axis], b[axis], i, nu), between(d[axis], c[axis], i, nu), j, nv);
            surface.vertices.push_back(p);
        }
    add_grid_triangles(surface, 0, nu, nv);
    surface.normals.resize(surface.vertices.size());
    return surface;
}

Surface tessellate(const Box& box) {
    Surface surface;
    const Vec3 from[2] = {box.min, box.max};
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            // u x v points along +axis; on the lower side u and v swap places to face outward.
            const int u = side == 1 ? (axis + 1) % 3 : (axis + 2) % 3;
            const int v = side == 1 ? (axis + 2) % 3 : (axis + 1) % 3;
            const std::uint32_t nu = box.divide[static_cast<std::size_t>(u)];
            const std::uint32_t nv = box.divide[static_cast<std::size_t>(v)];
            const auto first = static_cast<std::uint32_t>(surface.vertices.size());
            for (std::uint32_t j = 0; j <= nv; ++j)
                for (std::uint32_t i = 0; i <= nu; ++i) {
                    Vec3 p;
                    p[axis] = from[side][axis];
                    p[u] = between(box.min[u], box.max[u], i, nu);
                    p[v] = between(box.min[v], box.max[v], j, nv);
                    surface.vertices.push_back(p);
                }
            add_grid_triangles(surface, first, nu, nv);
        }
    if (box.rotate_z_degrees != 0) {
        const double angle = box.rotate_z_degrees * radians_per_degree;
        const double cosine = std::cos(angle), sine = std::sin(angle);
        const double mid_x = (static_cast<double>(box.min.x) + box.max.x) / 2;
        const double mid_y = (static_cast<double>(box.min.y) + box.max.y) / 2;
        for (Vec3& p : surface.vertices) {
            const double x = p.x - mid_x, y = p.y - mid_y;
            p.x = static_cast<float>(mid_x + cosine * x - sine * y);
            p.y = static_cast<float>(mid_y + sine * x + cosine * y);
        }
    }
    surface.normals.resize(surface.vertices.size());
    return surface;
}

Surface tessellate(const Sphere& sphere) {
    Surface surface;
    const std::uint32_t around = sphere.segments, rings = ring_count(sphere);
    const auto add_vertex = [&](double x, double y, double z) {
        const Vec3 normal{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
        surface.normals.push_back(normal);
        surface.vertices.push_back(sphere.center + normal * sphere.radius);
    };
    add_vertex(0, 0, 1);
    for (std::uint32_t ring = 1; ring < rings; ++ring) {
        const double theta = std::numbers::pi * ring / rings;
        for (std::uint32_t i = 0; i < around; ++i) {
            const double phi = 2 * std::numbers::pi * i / around;
            add_vertex(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
        }
    }
    add_vertex(0, 0, -1);

    // Vertex 0 is the north pole, then rings - 1 rings from north to south, then the south pole.
    const auto south = static_cast<std::uint32_t>(surface.vertices.size() - 1);
    const std::uint32_t last_ring = south - around;
    for (std::uint32_t i = 0; i < around; ++i) {
        const std::uint32_t next = (i + 1) % around;
        surface.triangles.push_back({0, 1 + i, 1 + next});
        for (std::uint32_t upper = 1; upper < last_ring; upper += around) {
            const std::uint32_t lower = upper + around;
            surface.triangles.push_back({upper + i, lower + i, lower + next});
            surface.triangles.push_back({upper + i, lower + next, upper + next});
        }
        surface.triangles.push_back({south, last_ring + next, last_ring + i});
    }
    return surface;
}

Surface tessellate(const Ripple& ripple) {
    Surface surface;
    const std::uint32_t n = ripple.cells;
    const double turns = 2 * std::numbers::pi / ripple.wavelength,
                 phase = ripple.phase_degrees * radians_per_degree;
    const float half = ripple.size / 2;
    const Vec3 c = ripple.center;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            const Vec3 p{between(c.x - half, c.x + half, i, n), between(c.y - half, c.y + half, j, n), 0};
            const double x = static_cast<double>(p.x) - c.x, y = static_cast<double>(p.y) - c.y,
                         r = std::hypot(x, y);
            const double angle = turns * r - phase, slope = -ripple.amplitude * turns * std::sin(angle);
            surface.vertices.push_back(
                {p.x, p.y, static_cast<float>(c.z + ripple.amplitude * std::cos(angle))});
            const double along = r > 0 ? slope / r : 0;
            surface.normals.push_back(
                trace::normalize(Vec3{static_cast<float>(-along * x), static_cast<float>(-along * y), 1}));
        }
    add_grid_triangles(surface, 0, n, n);
    if (!(ripple.depth > 0)) return surface;

    // The boundary, counter-clockwise from above; then each of its points on the bottom.
    std::vector<std::uint32_t> boundary;
    for (std::uint32_t i = 0; i < n; ++i) boundary.push_back(i);
    for (std::uint32_t j = 0; j < n; ++j) boundary.push_back(j * (n + 1) + n);
    for (std::uint32_t i = n; i > 0; --i) boundary.push_back(n * (n + 1) + i);
    for (std::uint32_t j = n; j > 0; --j) boundary.push_back(j * (n + 1));
    const auto around = static_cast<std::uint32_t>(boundary.size());
    const auto upper = static_cast<std::uint32_t>(surface.vertices.size()), lower = upper + around,
               middle = lower + around;
    for (const std::uint32_t b : boundary) surface.vertices.push_back(surface.vertices[b]);
    for (const std::uint32_t b : boundary)
        surface.vertices.push_back({surface.vertices[b].x, surface.vertices[b].y, c.z - ripple.depth});
    surface.vertices.push_back({c.x, c.y, c.z - ripple.depth});
    surface.normals.resize(surface.vertices.size());
    for (std::uint32_t i = 0; i < around; ++i) {
        const std::uint32_t next = (i + 1) % around;
        surface.triangles.push_back({upper + i, lower + i, lower + next});
        surface.triangles.push_back({upper + i, lower + next, upper + next});
        surface.triangles.push_back({middle, lower + next, lower + i});
    }
    return surface;
}

}  // namespace regather::scenes
