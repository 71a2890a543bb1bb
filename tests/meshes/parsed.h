// tests/meshes/parsed.h -- mesh files as text, what is read of them, and a box of 2 x 3 x 4 in every format:
// no two of its numbers are alike, so that axes, sides and signs cannot change places unseen.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string>

#include "meshes/mesh.h"
#include "tests/scenes/closed_surface.h"
#include "trace/bounds.h"
#include "trace/error.h"

namespace regather::meshes {

using Files = std::map<std::string, std::string>;

/// The mesh of a file t.* with these bytes, beside which lie `files`.
inline Mesh parsed(Format format, std::string_view bytes, const Files& files = {}) {
    return parse_mesh(format, {.bytes = bytes,
                               .file = "t",
                               .stem = "t",
                               .has_beside = [&](const std::string& name) { return files.contains(name); },
                               .read_beside = [&](const std::string& name) -> Neighbour {
                                   return {name, files.at(name)};
                               }});
}

/// The message of the DataError that refuses it, one line; "" when it is read.
inline std::string refused(Format format, std::string_view bytes, const Files& files = {}) {
    try {
        parsed(format, bytes, files);
    } catch (const trace::DataError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.what();
    }
    return "";
}

inline double area(const Mesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.surface.triangles)
        sum += triangle_area(mesh.surface.vertices[a], mesh.surface.vertices[b], mesh.surface.vertices[c]);
    return sum;
}

inline double volume(const Mesh& mesh) {
    return scenes::volume(mesh.surface.vertices, mesh.surface.triangles);
}

inline std::string notes(const Mesh& mesh) {
    std::string all;
    for (const std::string& note : mesh.notes) all += note + "\n";
    return all;
}

/// From (0, 0, 0) to (2, 3, 4): 12 triangles, closed, outward.
inline void expect_box(const Mesh& mesh, const std::string& what = "") {
    SCOPED_TRACE(what);
    EXPECT_EQ(mesh.surface.triangles.size(), 12u);
    EXPECT_NEAR(area(mesh), 52, 1e-5);
    EXPECT_NEAR(volume(mesh), 24, 1e-5);
    EXPECT_EQ(scenes::unpaired_edges(mesh.surface.vertices, mesh.surface.triangles), 0u);
    const trace::Bounds3 bounds = trace::bounds_of(mesh.surface.vertices);
    EXPECT_EQ(bounds.min, (Vec3{0, 0, 0}));
    EXPECT_EQ(bounds.max, (Vec3{2, 3, 4}));
    EXPECT_EQ(mesh.surface.normals.size(), mesh.surface.vertices.size());
    EXPECT_EQ(mesh.triangle_material.size(), mesh.surface.triangles.size());
}

inline constexpr std::array<std::array<int, 3>, 8> box_corners{
    {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {0, 0, 4}, {2, 0, 4}, {2, 3, 4}, {0, 3, 4}}};
/// Below, above, front (y = 0), right, back, left; from 0.
inline constexpr std::array<std::array<int, 4>, 6> box_faces{
    {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

/// `what`, wherever it stands, by another text.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

template <class Value>
void put(std::string& bytes, Value value, bool big_endian = false) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (big_endian) std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
}

}  // namespace regather::meshes
