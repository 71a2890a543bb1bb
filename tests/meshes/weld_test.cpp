#include "meshes/weld.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/tessellation.h"
#include "tests/scenes/closed_surface.h"

namespace regather::meshes {
namespace {

using scenes::Box, scenes::Quad, scenes::Sphere;
using scenes::is_closed;
using trace::Vec3;

double volume(const Surface& surface) {
    return scenes::volume(surface.vertices, surface.triangles);
}

TEST(Weld, GlassBecomesSolidAndFacesOutward) {
    Surface box = tessellate(Box{{0, 0, 0}, {1, 1, 1}});
    EXPECT_TRUE(is_closed(box));
    for (auto& triangle : box.triangles) std::swap(triangle[1], triangle[2]);
    EXPECT_NEAR(volume(as_solid(box, 0.1f)), 1, 1e-6);
    const Surface sheet = as_solid(tessellate(Quad{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {2, 2}}), 0.1f);
    EXPECT_TRUE(is_closed(sheet));
    EXPECT_NEAR(volume(sheet), 0.6, 1e-6);
}

TEST(Weld, ACavityStaysACavity) {
    Surface box = tessellate(Box{{0, 0, 0}, {1, 1, 1}}),
            hole = tessellate(Box{{0.25f, 0.25f, 0.25f}, {0.75f, 0.75f, 0.75f}});
    const auto first = static_cast<std::uint32_t>(box.vertices.size());
    box.vertices.insert(box.vertices.end(), hole.vertices.begin(), hole.vertices.end());
    box.normals.insert(box.normals.end(), hole.normals.begin(), hole.normals.end());
    for (const auto& [a, b, c] : hole.triangles) box.triangles.push_back({first + a, first + c, first + b});
    EXPECT_NEAR(volume(as_solid(box, 0.1f)), 1 - 0.125, 1e-6);
}

TEST(Weld, NormalsAreSmoothAcrossGentleEdgesOnly) {
    Surface sphere = tessellate(Sphere{{0, 0, 0}, 1, 32});
    sphere.normals.assign(sphere.vertices.size(), {});
    const Surface smooth = with_smooth_normals(sphere, 40);
    for (std::size_t v = 0; v < smooth.vertices.size(); ++v)
        EXPECT_GT(dot(smooth.normals[v], smooth.vertices[v]), 0.99f);
    const Surface box = with_smooth_normals(tessellate(Box{{0, 0, 0}, {1, 1, 1}}), 40);
    for (const Vec3 n : box.normals) EXPECT_NEAR(std::abs(n.x) + std::abs(n.y) + std::abs(n.z), 1, 1e-6);
}

TEST(Weld, SimplifyingKeepsTheShapeAndDropsDetail) {
    const Surface sphere = tessellate(Sphere{{0, 0, 0}, 1, 256});
    const Surface simple = simplified(sphere, 0.1f);
    EXPECT_LT(simple.triangles.size(), sphere.triangles.size() / 4);
    EXPECT_NEAR(volume(simple), 4.0 / 3 * std::numbers::pi, 0.1);
}

}  // namespace
}  // namespace regather::meshes
