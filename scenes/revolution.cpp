#include "scenes/revolution.h"

#include <cmath>
#include <numbers>

namespace regather::scenes {

namespace {

using Point = std::array<double, 2>;  // Radius and height.
using Profile = std::vector<Point>;

// Least cosine of the angle between two stretches that are shaded as one.
constexpr double crease = std::numbers::sqrt2 / 2, no_crease = -1;

struct Axis {
    std::array<double, 3> base, u, v, w;  // u x v = w, unit length; w along the axis.
};

// To the right of the course from a to b.
Point outward(Point a, Point b) {
    const double r = b[1] - a[1], z = a[0] - b[0], length = std::hypot(r, z);
    return {r / length, z / length};
}

Point mean_of(Point a, Point b) {
    const double r = a[0] + b[0], z = a[1] + b[1], length = std::hypot(r, z);
    return {r / length, z / length};
}

std::uint64_t triangles_of(const Profile& profile, std::uint32_t segments) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i + 1 < profile.size(); ++i)
        count += std::uint64_t{segments} * ((profile[i][0] > 0) + (profile[i + 1][0] > 0));
    return count;
}

// Each stretch of the profile has two rings of its own: the places of equal points are equal, their normals
// may differ.
Surface revolve(const Profile& profile, std::uint32_t segments, const Axis& axis, bool smooth,
                double least_cosine = crease) {
    Surface surface;
    const std::size_t stretches = profile.size() - 1;
    const bool is_ring = profile.front() == profile.back();
    const auto normal_of = [&](std::size_t i) { return outward(profile[i], profile[i + 1]); };
    const auto shared = [&](std::size_t own, std::size_t other) {
        const Point a = normal_of(own), b = normal_of(other);
        return a[0] * b[0] + a[1] * b[1] > least_cosine ? mean_of(a, b) : a;
    };
    const auto add_vertex = [&](Point at, Point normal, std::uint32_t i) {
        const double phi = 2 * std::numbers::pi * i / segments, c = std::cos(phi), s = std::sin(phi);
        Vec3 p, n;
        for (int k = 0; k < 3; ++k) {
            const auto a = static_cast<std::size_t>(k);
            const double around = axis.u[a] * c + axis.v[a] * s;
            p[k] = static_cast<float>(axis.base[a] + axis.w[a] * at[1] + around * at[0]);
            n[k] = static_cast<float>(axis.w[a] * normal[1] + around * normal[0]);
        }
        surface.vertices.push_back(p);
        surface.normals.push_back(smooth ? trace::normalize(n) : Vec3{});
    };
    for (std::size_t stretch = 0; stretch < stretches; ++stretch) {
        const Point a = profile[stretch], b = profile[stretch + 1];
        const bool has_before = stretch > 0 || is_ring, has_after = stretch + 1 < stretches || is_ring;
        const Point at_a =
            has_before ? shared(stretch, (stretch + stretches - 1) % stretches) : normal_of(stretch);
        const Point at_b = has_after ? shared(stretch, (stretch + 1) % stretches) : normal_of(stretch);
        const auto first = static_cast<std::uint32_t>(surface.vertices.size());
        for (std::uint32_t i = 0; i < segments; ++i) add_vertex(a, at_a, i);
        for (std::uint32_t i = 0; i < segments; ++i) add_vertex(b, at_b, i);
        for (std::uint32_t i = 0; i < segments; ++i) {
            const std::uint32_t a0 = first + i, a1 = first + (i + 1) % segments, b0 = a0 + segments,
                                b1 = a1 + segments;
            if (a[0] > 0) surface.triangles.push_back({a0, a1, b1});
            if (b[0] > 0) surface.triangles.push_back({a0, b1, b0});
        }
    }
    return surface;
}

Axis upright(Vec3 base) {
    return {{base.x, base.y, base.z}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

Axis axis_along(Vec3 base, double x, double y, double z) {
    const double length = std::sqrt(x * x + y * y + z * z);
    const std::array<double, 3> w{x / length, y / length, z / length};
    // The coordinate axis that is farthest from w.
    std::array<double, 3> far{};
    std::size_t least = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (std::abs(w[k]) < std::abs(w[least])) least = k;
    far[least] = 1;
    const auto across = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                     a[0] * b[1] - a[1] * b[0]};
    };
    std::array<double, 3> u = across(far, w);
    const double scale = 1 / std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    for (double& k : u) k *= scale;
    return {{base.x, base.y, base.z}, u, across(w, u), w};
}

Profile profile_of(const Lathe& lathe) {
    Profile profile;
    for (const auto& [r, z] : lathe.profile) profile.push_back({r, z});
    return profile;
}

std::array<double, 3> course_of(const Cylinder& c) {
    return {static_cast<double>(c.to.x) - c.from.x, static_cast<double>(c.to.y) - c.from.y,
            static_cast<double>(c.to.z) - c.from.z};
}

Profile profile_of(const Cylinder& cylinder) {
    const auto [x, y, z] = course_of(cylinder);
    const double height = std::sqrt(x * x + y * y + z * z);
    Profile profile{{0, 0}};
    if (cylinder.radius > 0) profile.push_back({cylinder.radius, 0});
    if (cylinder.radius_to > 0) profile.push_back({cylinder.radius_to, height});
    profile.push_back({0, height});
    return profile;
}

Profile profile_of(const Torus& torus) {
    Profile profile;
    for (std::uint32_t i = 0; i < torus.tube_segments; ++i) {
        const double angle = 2 * std::numbers::pi * i / torus.tube_segments;
        profile.push_back({torus.radius + torus.tube * std::cos(angle), torus.tube * std::sin(angle)});
    }
    profile.push_back(profile.front());
    return profile;
}

}  // namespace

std::uint64_t triangle_count(const Lathe& lathe) {
    return triangles_of(profile_of(lathe), lathe.segments);
}
std::uint64_t triangle_count(const Cylinder& cylinder) {
    return triangles_of(profile_of(cylinder), cylinder.segments);
}
std::uint64_t triangle_count(const Torus& torus) {
    return 2ull * torus.segments * torus.tube_segments;
}

Surface tessellate(const Lathe& lathe) {
    return revolve(profile_of(lathe), lathe.segments, upright(lathe.center), lathe.smooth);
}

Surface tessellate(const Cylinder& cylinder) {
    const auto [x, y, z] = course_of(cylinder);
    return revolve(profile_of(cylinder), cylinder.segments, axis_along(cylinder.from, x, y, z),
                   cylinder.smooth);
}

Surface tessellate(const Torus& torus) {
    return revolve(profile_of(torus), torus.segments,
                   axis_along(torus.center, torus.axis.x, torus.axis.y, torus.axis.z), true, no_crease);
}

}  // namespace regather::scenes
