#include "spatial/rays/triangle.h"

#include <fmt/format.h>

#include <cmath>

#include "trace/error.h"

namespace regather::spatial {

std::vector<trace::Bounds3> triangle_bounds(std::span<const trace::Vec3> vertices,
                                            std::span<const TriangleIndices> triangles) {
    constexpr float farthest = 1e18f;
    std::vector<trace::Bounds3> boxes(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (const std::uint32_t v : triangles[t]) {
            if (v >= vertices.size())
                throw trace::DataError(fmt::format(
                    "triangle {}: found vertex index {}, expected one under {}", t, v, vertices.size()));
            for (int axis = 0; axis < 3; ++axis)
                if (!(std::fabs(vertices[v][axis]) <= farthest))
                    throw trace::DataError(
                        fmt::format("triangle {}: found {} in vertex {}, expected a number from -{} to {}", t,
                                    vertices[v][axis], v, farthest, farthest));
            boxes[t].include(vertices[v]);
        }
    }
    return boxes;
}

std::array<double, 3> across(trace::Vec3 a, trace::Vec3 b, trace::Vec3 c) {
    double ab[3], ac[3];
    for (int axis = 0; axis < 3; ++axis) {
        ab[axis] = double(b[axis]) - double(a[axis]);
        ac[axis] = double(c[axis]) - double(a[axis]);
    }
    return {ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2], ab[0] * ac[1] - ab[1] * ac[0]};
}

}  // namespace regather::spatial
