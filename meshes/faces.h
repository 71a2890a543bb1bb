// meshes/faces.h -- the faces of a mesh file as it has them, polygons of any number of corners, and their
// triangles.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "meshes/notes.h"
#include "meshes/surface.h"

namespace regather::meshes {

/// Face f has the corners corners[ends[f - 1]] to corners[ends[f] - 1] (from 0 for f = 0), numbers of
/// vertices.
struct Faces {
    std::vector<std::uint32_t> corners, ends;
    std::size_t size() const { return ends.size(); }
};

struct FaceTriangles {
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> face;    ///< Of each triangle.
    std::uint64_t too_few_corners = 0;  ///< Faces of fewer than three: left out.
};

/// Notes faces of fewer than three corners, and those that cross themselves. `refuse(face, found, expected)`
/// throws; it is told of a face that is too large to be filled (meshes/polygon.h) and of the first that
/// exceeds most_triangles.
using RefuseFace =
    std::function<void(std::size_t face, const std::string& found, const std::string& expected)>;
FaceTriangles triangles_of(const Faces& faces, std::span<const Vec3> vertices, const RefuseFace& refuse,
                           Notes& notes);

}  // namespace regather::meshes
