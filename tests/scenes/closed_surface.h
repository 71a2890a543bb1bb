// tests/scenes/closed_surface.h -- what holds for every closed surface, whatever made it: its edges pair up
// and the divergence theorem gives its volume.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include "trace/vec.h"

namespace regather::scenes {

using Corners = std::array<std::uint32_t, 3>;

/// Edges, by the exact floats of their ends, that are not met once in each direction.
inline std::size_t unpaired_edges(std::span<const trace::Vec3> vertices, std::span<const Corners> triangles) {
    using Point = std::tuple<float, float, float>;
    const auto point = [&](std::uint32_t i) { return Point{vertices[i].x, vertices[i].y, vertices[i].z}; };
    std::map<std::pair<Point, Point>, int> met;
    for (const Corners& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) ++met[{point(t[k]), point(t[(k + 1) % 3])}];
    std::size_t unpaired = 0;
    for (const auto& [edge, times] : met) {
        const auto back = met.find({edge.second, edge.first});
        if (times != 1 || back == met.end() || back->second != 1) ++unpaired;
    }
    return unpaired;
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

}  // namespace regather::scenes
