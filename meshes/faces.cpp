#include "meshes/faces.h"

#include <fmt/format.h>

#include "meshes/polygon.h"

namespace regather::meshes {

FaceTriangles triangles_of(const Faces& faces, std::span<const Vec3> vertices, const RefuseFace& refuse,
                           Notes& notes) {
    FaceTriangles result;
    Triangulator triangulator;
    std::vector<Vec3> polygon;
    std::uint32_t begin = 0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const std::span corners(faces.corners.data() + begin, faces.ends[f] - begin);
        begin = faces.ends[f];
        if (corners.size() < 3) {
            ++result.too_few_corners;
            continue;
        }
        if (result.triangles.size() + corners.size() - 2 > most_triangles)
            refuse(f, fmt::format("more than {} triangles", most_triangles), "at most as many");
        polygon.clear();
        for (const std::uint32_t v : corners) polygon.push_back(vertices[v]);
        const Triangulator::Result filled = triangulator.fill(polygon);
        if (filled == Triangulator::Result::too_large)
            refuse(f, fmt::format("a face of {} corners that is not convex", corners.size()),
                   fmt::format("at most {} corners", most_concave_corners));
        if (filled == Triangulator::Result::crosses_itself)
            notes.add("faces that cross themselves are filled as far as they can be");
        for (const auto& [a, b, c] : triangulator.triangles()) {
            result.triangles.push_back({corners[a], corners[b], corners[c]});
            result.face.push_back(static_cast<std::uint32_t>(f));
        }
    }
    notes.add("faces of fewer than three corners are left out", result.too_few_corners);
    return result;
}

}  // namespace regather::meshes
