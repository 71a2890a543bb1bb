#include "meshes/weld.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "trace/bounds.h"

namespace regather::meshes {

namespace {

struct HashOfPlace {
    std::size_t operator()(const std::array<std::uint32_t, 3>& bits) const {
        std::uint64_t hash = 0;
        for (const std::uint32_t word : bits) hash = (hash ^ word) * 0x9e3779b97f4a7c15ull + (hash >> 29);
        return static_cast<std::size_t>(hash);
    }
};

std::array<std::uint32_t, 3> bits_of(Vec3 p) {
    return {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
            std::bit_cast<std::uint32_t>(p.z + 0.0f)};  // + 0: one zero
}

Vec3 scaled_normal(const Surface& surface, const Triangle& t) {  // length: twice the area
    const Vec3 a = surface.vertices[t[0]];
    return cross(surface.vertices[t[1]] - a, surface.vertices[t[2]] - a);
}

// Directed edges of welded vertices -> how often, less how often the other way round.
std::map<std::array<std::uint32_t, 2>, int> open_edges(const std::vector<Triangle>& triangles,
                                                       const std::vector<std::uint32_t>& place) {
    std::map<std::array<std::uint32_t, 2>, int> balance;
    for (const Triangle& t : triangles)
        for (std::size_t e = 0; e < 3; ++e) {
            const std::uint32_t a = place[t[e]], b = place[t[(e + 1) % 3]];
            if (a < b) ++balance[{a, b}];
            if (b < a) --balance[{b, a}];
        }
    std::erase_if(balance, [](const auto& entry) { return entry.second == 0; });
    return balance;
}

// The triangles of each part that hangs together, by its first triangle.
std::vector<std::vector<std::size_t>> parts_of(const Surface& surface,
                                               const std::vector<std::uint32_t>& place) {
    std::vector<std::uint32_t> parent(surface.vertices.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const Triangle& t : surface.triangles) {
        parent[root(place[t[1]])] = root(place[t[0]]);
        parent[root(place[t[2]])] = root(place[t[0]]);
    }
    std::vector<std::vector<std::size_t>> parts;
    std::unordered_map<std::uint32_t, std::size_t> part_of;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const auto [entry, is_first] = part_of.emplace(root(place[surface.triangles[t][0]]), parts.size());
        if (is_first) parts.emplace_back();
        parts[entry->second].push_back(t);
    }
    return parts;
}

trace::Bounds3 bounds_of(const Surface& surface, const std::vector<Triangle>& triangles) {
    trace::Bounds3 bounds;
    for (const Triangle& t : triangles)
        for (const std::uint32_t v : t) bounds.include(surface.vertices[v]);
    return bounds;
}

bool strictly_within(const trace::Bounds3& inner, const trace::Bounds3& outer) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(inner.min[axis] > outer.min[axis] && inner.max[axis] < outer.max[axis])) return false;
    return true;
}

double signed_volume(const Surface& surface, const std::vector<Triangle>& triangles) {
    const Vec3 origin = surface.vertices[triangles.front()[0]];  // near: no cancellation
    double volume = 0;
    for (const Triangle& t : triangles) {
        const Vec3 a = surface.vertices[t[0]] - origin, b = surface.vertices[t[1]] - origin,
                   c = surface.vertices[t[2]] - origin;
        volume += static_cast<double>(dot(a, cross(b, c)));
    }
    return volume / 6;
}

// Both faces of the sheet, half a thickness to each side, and its rim.
void add_sheet(const Surface& surface, const std::vector<Triangle>& triangles,
               const std::vector<std::uint32_t>& place, float thickness, Surface& out) {
    std::map<std::uint32_t, std::array<std::uint32_t, 2>>
        sides;  // of a place: vertex in front, vertex behind
    std::map<std::uint32_t, Vec3> normals;
    for (const Triangle& t : triangles)
        for (const std::uint32_t v : t) normals[place[v]] += scaled_normal(surface, t);
    for (const Triangle& t : triangles)
        for (const std::uint32_t v : t) {
            if (sides.contains(place[v])) continue;
            const float size = length(normals[place[v]]);
            const Vec3 half =
                size > 0 ? normals[place[v]] * (0.5f * thickness / size) : Vec3{0, 0, 0.5f * thickness};
            const auto first = static_cast<std::uint32_t>(out.vertices.size());
            sides[place[v]] = {first, first + 1};
            out.vertices.insert(out.vertices.end(), {surface.vertices[v] + half, surface.vertices[v] - half});
        }
    for (const Triangle& t : triangles) {
        const auto a = sides[place[t[0]]], b = sides[place[t[1]]], c = sides[place[t[2]]];
        out.triangles.push_back({a[0], b[0], c[0]});
        out.triangles.push_back({a[1], c[1], b[1]});
    }
    for (const auto& [edge, balance] : open_edges(triangles, place))
        for (int i = 0; i < std::abs(balance); ++i) {
            const auto a = sides[edge[balance > 0 ? 0 : 1]], b = sides[edge[balance > 0 ? 1 : 0]];
            out.triangles.push_back({a[1], b[1], b[0]});
            out.triangles.push_back({a[1], b[0], a[0]});
        }
    out.normals.resize(out.vertices.size());
}

}  // namespace

std::vector<std::uint32_t> weld(const Surface& surface) {
    std::vector<std::uint32_t> place(surface.vertices.size());
    std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, HashOfPlace> places;
    for (std::size_t v = 0; v < place.size(); ++v)
        place[v] = places.emplace(bits_of(surface.vertices[v]), static_cast<std::uint32_t>(places.size()))
                       .first->second;
    return place;
}

Surface with_smooth_normals(const Surface& surface, double crease_degrees) {
    const bool has_normals =
        surface.normals.size() == surface.vertices.size() &&
        std::any_of(surface.normals.begin(), surface.normals.end(), [](Vec3 n) { return n != Vec3{}; });
    if (has_normals) return surface;
    const auto least_cosine = static_cast<float>(std::cos(crease_degrees * std::numbers::pi / 180));
    const std::vector<std::uint32_t> place = weld(surface);
    std::vector<Vec3> scaled, unit;
    std::vector<std::vector<std::uint32_t>> around(surface.vertices.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        scaled.push_back(scaled_normal(surface, surface.triangles[t]));
        const float size = length(scaled.back());
        unit.push_back(size > 0 ? scaled.back() * (1 / size) : Vec3{});
        for (const std::uint32_t v : surface.triangles[t])
            around[place[v]].push_back(static_cast<std::uint32_t>(t));
    }
    // A fan of thousands of triangles around one place would cost their square.
    constexpr std::size_t most_around = 256;
    Surface smooth;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> made;  // of a place: its vertices
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        Triangle triangle{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t v = surface.triangles[t][corner];
            const auto& neighbours = around[place[v]];
            Vec3 sum;
            if (neighbours.size() <= most_around)
                for (const std::uint32_t n : neighbours)
                    if (dot(unit[n], unit[t]) >= least_cosine) sum += scaled[n];
            const float size = length(sum);
            const Vec3 normal = size > 0 ? sum * (1 / size) : unit[t];
            std::vector<std::uint32_t>& vertices = made[place[v]];
            const auto same = std::find_if(vertices.begin(), vertices.end(),
                                           [&](std::uint32_t i) { return smooth.normals[i] == normal; });
            if (same != vertices.end()) {
                triangle[corner] = *same;
                continue;
            }
            triangle[corner] = static_cast<std::uint32_t>(smooth.vertices.size());
            if (vertices.size() < most_around) vertices.push_back(triangle[corner]);
            smooth.vertices.push_back(surface.vertices[v]);
            smooth.normals.push_back(normal);
        }
        smooth.triangles.push_back(triangle);
    }
    return smooth;
}

Surface as_solid(const Surface& surface, float thickness) {
    const std::vector<std::uint32_t> place = weld(surface);
    std::vector<std::vector<Triangle>> parts;
    std::vector<trace::Bounds3> bounds;
    for (const std::vector<std::size_t>& part : parts_of(surface, place)) {
        std::vector<Triangle>& triangles = parts.emplace_back();
        for (const std::size_t t : part) triangles.push_back(surface.triangles[t]);
        bounds.push_back(bounds_of(surface, triangles));
    }
    // Beyond this many parts (beads, leaves) nobody looks for cavities.
    constexpr std::size_t most_compared = 2000;
    Surface solid{surface.vertices, surface.normals, {}};
    solid.normals.resize(solid.vertices.size());
    Surface sheets;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (!open_edges(parts[p], place).empty()) {
            add_sheet(surface, parts[p], place, thickness, sheets);
            continue;
        }
        const bool cavity = parts.size() <= most_compared &&
                            std::any_of(bounds.begin(), bounds.end(), [&](const trace::Bounds3& b) {
                                return strictly_within(bounds[p], b);
                            });
        const bool turn = !cavity && signed_volume(surface, parts[p]) < 0;
        for (const Triangle& t : parts[p]) solid.triangles.push_back(turn ? Triangle{t[0], t[2], t[1]} : t);
        if (turn)
            for (const Triangle& t : parts[p])
                for (const std::uint32_t v : t)
                    if (dot(solid.normals[v], scaled_normal(surface, t)) > 0)
                        solid.normals[v] = -solid.normals[v];
    }
    const auto first = static_cast<std::uint32_t>(solid.vertices.size());
    solid.vertices.insert(solid.vertices.end(), sheets.vertices.begin(), sheets.vertices.end());
    solid.normals.insert(solid.normals.end(), sheets.normals.begin(), sheets.normals.end());
    for (const Triangle& t : sheets.triangles)
        solid.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    return solid;
}

Surface simplified(const Surface& surface, float cell) {
    struct Cluster {
        double x = 0, y = 0, z = 0, count = 0;
    };
    std::vector<Cluster> clusters;
    std::map<std::array<std::int64_t, 3>, std::uint32_t> cells;
    std::vector<std::uint32_t> cluster_of(surface.vertices.size());
    for (std::size_t v = 0; v < cluster_of.size(); ++v) {
        const Vec3 p = surface.vertices[v];
        const auto index = [&](float x) { return static_cast<std::int64_t>(std::floor(double{x} / cell)); };
        const auto [entry, is_new] = cells.emplace(std::array{index(p.x), index(p.y), index(p.z)},
                                                   static_cast<std::uint32_t>(clusters.size()));
        if (is_new) clusters.emplace_back();
        cluster_of[v] = entry->second;
        Cluster& cluster = clusters[entry->second];
        cluster.x += p.x;
        cluster.y += p.y;
        cluster.z += p.z;
        ++cluster.count;
    }
    Surface result;
    for (const Cluster& c : clusters)
        result.vertices.push_back({static_cast<float>(c.x / c.count), static_cast<float>(c.y / c.count),
                                   static_cast<float>(c.z / c.count)});
    result.normals.resize(result.vertices.size());
    for (const Triangle& t : surface.triangles) {
        const std::uint32_t a = cluster_of[t[0]], b = cluster_of[t[1]], c = cluster_of[t[2]];
        if (a != b && b != c && c != a) result.triangles.push_back({a, b, c});
    }
    drop_degenerate(result);
    return result;
}

}  // namespace regather::meshes
