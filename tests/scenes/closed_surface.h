// tests/scenes/closed_surface.h -- what holds for every closed surface, whatever made it: its edges pair up
// and the divergence theorem gives its volume.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include "meshes/surface.h"
#include "trace/vec.h"

namespace regather::scenes {

using Corners = std::array<std::uint32_t, 3>;

/// How often each edge is met, by direction and by the exact floats of its ends.
using Point = std::tuple<float, float, float>;
inline std::map<std::pair<Point, Point>, int> edges_of(std::span<const trace::Vec3> vertices,
                                                       std::span<const Corners> triangles) {
    const auto point = [&](std::uint32_t i) { return Point{vertices[i].x, vertices[i].y, vertices[i].z}; };
    std::map<std::pair<Point, Point>, int> met;
    for (const Corners& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) ++met[{point(t[k]), point(t[(k + 1) % 3])}];
    return met;
}

/// Edges that are not met once in each direction.
inline std::size_t unpaired_edges(std::span<const trace::Vec3> vertices, std::span<const Corners> triangles) {
    const auto met = edges_of(vertices, triangles);
    return static_cast<std::size_t>(std::count_if(met.begin(), met.end(), [&](const auto& of_edge) {
        const auto& [edge, times] = of_edge;
        const auto back = met.find({edge.second, edge.first});
        return times != 1 || back == met.end() || back->second != 1;
    }));
}

/// True when every edge is met as often in one direction as in the other: light cannot get in.
inline bool is_closed(const meshes::Surface& surface) {
    const auto met = edges_of(surface.vertices, surface.triangles);
    return std::all_of(met.begin(), met.end(), [&](const auto& of_edge) {
        const auto back = met.find({of_edge.first.second, of_edge.first.first});
        return back != met.end() && back->second == of_edge.second;
    });
}

/// Sum of a . (b x c) / 6: the enclosed volume, positive when the triangles face outward.
inline double volume(std::span<const trace::Vec3> vertices, std::span<const Corners> triangles) {
    double sum = 0;
    for (const Corners& t : triangles) {
        const trace::Vec3 a = vertices[t[0]], b = vertices[t[1]], c = vertices[t[2]];
        sum += a.x * (double{b.y} * c.z - double{b.z} * c.y) + a.y * (double{b.z} * c.x - double{b.x} * c.z) +
               a.z * (double{b.x} * c.y - double{b.y} * c.x);
    }
    return sum / 6;
}

inline std::size_t unpaired_edges(const meshes::Surface& surface) {
    return unpaired_edges(surface.vertices, surface.triangles);
}
inline double volume(const meshes::Surface& surface) {
    return volume(surface.vertices, surface.triangles);
}

}  // namespace regather::scenes
