// tests/spatial/brute_force.h -- the nearest photons by their definition, to hold searches against.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "spatial/photons/nearest.h"
#include "trace/photon.h"

namespace regather::spatial {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Smaller numbers first at equal distances.
inline bool is_nearer(const Neighbor& a, const Neighbor& b) {
    return a.distance2 < b.distance2 || (a.distance2 == b.distance2 && a.node < b.node);
}

/// All distances, sorted by (distance, node); the first k within the radius.
inline std::vector<Neighbor> brute_force(std::span<const Photon> photons, Vec3 point, std::size_t k,
                                         float radius) {
    std::vector<Neighbor> all;
    for (std::uint32_t i = 0; i < photons.size(); ++i) {
        const Vec3 d = point - photons[i].position;
        if (const float distance2 = dot(d, d); distance2 <= radius * radius) all.push_back({distance2, i});
    }
    std::sort(all.begin(), all.end(), is_nearer);
    all.resize(std::min(all.size(), k));
    return all;
}

/// Distances and nodes, one by one.
inline bool same(const std::vector<Neighbor>& a, const std::vector<Neighbor>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Neighbor& x, const Neighbor& y) {
        return x.distance2 == y.distance2 && x.node == y.node;
    });
}

}  // namespace regather::spatial
