#include "imports/maps/light_cluster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

#include "trace/bounds.h"

namespace regather::imports {

using trace::Vec3;

namespace {

using Place = std::array<double, 3>;
using Parts = std::vector<std::size_t>;  // Part of each triangle, numbered by the first triangle of each.

Place place_of(Vec3 p) {
    return {p.x + 0.0, p.y + 0.0, p.z + 0.0};  // -0 is 0.
}

std::size_t root(std::vector<std::size_t>& parent, std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

Parts connected(const Surface& surface) {
    std::vector<std::size_t> parent(surface.triangles.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    std::map<Place, std::size_t> first_at;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        for (const std::uint32_t corner : surface.triangles[t]) {
            const auto [found, is_first] = first_at.emplace(place_of(surface.vertices[corner]), t);
            const std::size_t a = root(parent, found->second), b = root(parent, t);
            parent[std::max(a, b)] = std::min(a, b);
        }
    }
    for (std::size_t t = 0; t < parent.size(); ++t) parent[t] = root(parent, t);
    return parent;
}

std::size_t count_of(const Parts& parts) {
    std::size_t count = 0;
    for (std::size_t t = 0; t < parts.size(); ++t) count += parts[t] == t;
    return count;
}

void merge(const Surface& surface, Parts& parts, double cell) {
    std::map<std::size_t, trace::Bounds3> boxes;
    for (std::size_t t = 0; t < parts.size(); ++t)
        for (const std::uint32_t corner : surface.triangles[t])
            boxes[parts[t]].include(surface.vertices[corner]);
    std::map<Place, std::size_t> first_in;
    std::map<std::size_t, std::size_t> becomes;
    for (const auto& [part, box] : boxes) {
        Place centre;
        for (int axis = 0; axis < 3; ++axis)
            centre[static_cast<std::size_t>(axis)] =
                std::floor((double{box.min[axis]} + double{box.max[axis]}) / (2 * cell));
        becomes[part] = first_in.emplace(centre, part).first->second;
    }
    for (std::size_t& part : parts) part = becomes[part];
}

std::vector<Surface> cut(const Surface& surface, const Parts& parts) {
    std::vector<Surface> result;
    std::map<std::size_t, std::size_t> number;
    std::vector<std::map<std::uint32_t, std::uint32_t>> vertex_in;
    for (std::size_t t = 0; t < parts.size(); ++t) {
        const auto [found, is_first] = number.emplace(parts[t], result.size());
        if (is_first) {
            result.emplace_back();
            vertex_in.emplace_back();
        }
        Surface& part = result[found->second];
        auto& vertices = vertex_in[found->second];
        std::array<std::uint32_t, 3> triangle;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t from = surface.triangles[t][corner];
            const auto [at, is_next] =
                vertices.emplace(from, static_cast<std::uint32_t>(part.vertices.size()));
            if (is_next) {
                part.vertices.push_back(surface.vertices[from]);
                part.normals.push_back(surface.normals[from]);
            }
            triangle[corner] = at->second;
        }
        part.triangles.push_back(triangle);
    }
    return result;
}

}  // namespace

std::vector<std::vector<Surface>> cluster_lights(std::span<const Surface> surfaces, std::size_t most) {
    std::vector<Parts> parts;
    for (const Surface& surface : surfaces) parts.push_back(connected(surface));
    const auto total = [&] {
        std::size_t count = 0;
        for (const Parts& each : parts) count += count_of(each);
        return count;
    };
    for (double cell = 1; total() > most && cell < 1e12; cell *= 2)
        for (std::size_t i = 0; i < surfaces.size(); ++i) merge(surfaces[i], parts[i], cell);
    std::vector<std::vector<Surface>> result;
    for (std::size_t i = 0; i < surfaces.size(); ++i) result.push_back(cut(surfaces[i], parts[i]));
    return result;
}

}  // namespace regather::imports
