#include "meshes/surface.h"

#include <algorithm>
#include <cmath>

namespace regather::meshes {

namespace {

auto has_no_area(const Surface& surface) {
    return [&surface](const Triangle& t) {
        return !(triangle_area(surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]) > 0);
    };
}

}  // namespace

double triangle_area(Vec3 a, Vec3 b, Vec3 c) {
    const double ux = static_cast<double>(b.x) - a.x, uy = static_cast<double>(b.y) - a.y;
    const double uz = static_cast<double>(b.z) - a.z, vx = static_cast<double>(c.x) - a.x;
    const double vy = static_cast<double>(c.y) - a.y, vz = static_cast<double>(c.z) - a.z;
    const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    return std::sqrt(x * x + y * y + z * z) / 2;
}

std::uint64_t degenerate_count(const Surface& surface) {
    return static_cast<std::uint64_t>(
        std::count_if(surface.triangles.begin(), surface.triangles.end(), has_no_area(surface)));
}

std::uint64_t drop_degenerate(Surface& surface, std::vector<std::uint32_t>* tags) {
    const auto gone = has_no_area(surface);
    std::size_t kept = 0;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (gone(surface.triangles[t])) continue;
        surface.triangles[kept] = surface.triangles[t];
        if (tags != nullptr) (*tags)[kept] = (*tags)[t];
        ++kept;
    }
    const std::uint64_t dropped = surface.triangles.size() - kept;
    surface.triangles.resize(kept);
    if (tags != nullptr) tags->resize(kept);
    return dropped;
}

void drop_unused_vertices(Surface& surface) {
    std::vector<std::uint32_t> place(surface.vertices.size(), 0);
    for (const Triangle& t : surface.triangles)
        for (const std::uint32_t v : t) place[v] = 1;
    std::uint32_t kept = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
        if (place[v] == 0) continue;
        surface.vertices[kept] = surface.vertices[v];
        if (v < surface.normals.size()) surface.normals[kept] = surface.normals[v];
        place[v] = kept++;
    }
    if (kept == surface.vertices.size()) return;
    surface.vertices.resize(kept);
    surface.normals.resize(std::min<std::size_t>(surface.normals.size(), kept));
    for (Triangle& t : surface.triangles)
        for (std::uint32_t& v : t) v = place[v];
}

}  // namespace regather::meshes
