// tests/spatial/rays/soup.h -- triangle soups to build structures over: random ones, and some drawn by hand.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "spatial/rays/triangle.h"
#include "trace/bounds.h"
#include "trace/vec.h"

namespace regather::spatial {

constexpr float endless = std::numeric_limits<float>::infinity();  ///< As far as a ray goes.

struct Soup {
    std::vector<trace::Vec3> vertices;
    std::vector<TriangleIndices> triangles;

    void add(trace::Vec3 a, trace::Vec3 b, trace::Vec3 c) {
        const auto first = std::uint32_t(vertices.size());
        vertices.insert(vertices.end(), {a, b, c});
        triangles.push_back({first, first + 1, first + 2});
    }
    /// A triangle whose box is [low, high].
    void add_spanning(trace::Vec3 low, trace::Vec3 high) {
        add(low, {high.x, high.y, low.z}, {low.x, high.y, high.z});
    }
    trace::Vec3 corner(std::size_t triangle, std::size_t i) const { return vertices[triangles[triangle][i]]; }
};

/// In [0, 1), the same on every machine.
inline float uniform(std::mt19937& random) {
    return float(random() >> 8) * 0x1p-24f;
}
inline trace::Vec3 uniform3(std::mt19937& random) {
    const float x = uniform(random), y = uniform(random), z = uniform(random);
    return {x, y, z};
}

/// Triangles of about `size` in the unit cube; every fourth lies flat in a plane of a grid of 16 (as walls
/// and boxes do), so that planes coincide.
inline Soup random_soup(std::size_t count, float size, unsigned seed) {
    std::mt19937 random(seed);
    Soup soup;
    for (std::size_t t = 0; t < count; ++t) {
        const trace::Vec3 at = uniform3(random);
        std::array<trace::Vec3, 3> corners;
        for (trace::Vec3& corner : corners)
            corner = at + (uniform3(random) - trace::Vec3{0.5f, 0.5f, 0.5f}) * size;
        if (t % 4 == 0) {
            const int axis = int(t / 4 % 3);
            for (trace::Vec3& corner : corners) corner[axis] = float(int(at[axis] * 16)) / 16;
        }
        soup.add(corners[0], corners[1], corners[2]);
    }
    return soup;
}

inline trace::Vec3 centre(const trace::Bounds3& box) {
    return (box.min + box.max) * 0.5f;
}

/// Mean distance of the centres of boxes with consecutive labels, over that of random pairs.
inline double neighbour_distance(const std::vector<trace::Bounds3>& boxes) {
    std::mt19937 random(7);
    double near = 0, far = 0;
    for (std::size_t i = 1; i < boxes.size(); ++i) {
        near += double(length(centre(boxes[i]) - centre(boxes[i - 1])));
        far +=
            double(length(centre(boxes[random() % boxes.size()]) - centre(boxes[random() % boxes.size()])));
    }
    return near / far;
}

}  // namespace regather::spatial
