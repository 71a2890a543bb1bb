#include "scenes/tuft.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/scenes/closed_surface.h"

namespace regather::scenes {
namespace {

Tuft grass() {
    return {{2, -1, 0.25f}, 0.07f, 400, 0.3f, 0.008f, 0.12f, 3, 9};
}

// Vertices of a blade: two at each of `segments` heights, from its start, and the tip.
std::size_t corners_of(const Tuft& tuft) {
    return 2 * tuft.segments + 1;
}

TEST(Tuft, HasItsBladesTriangles) {
    // Three segments: two quads and a tip.
    const Surface surface = tessellate(grass());
    EXPECT_EQ(triangle_count(grass()), 400u * 5);
    EXPECT_EQ(surface.triangles.size(), 400u * 5);
    EXPECT_EQ(surface.vertices.size(), 400u * 7);
    EXPECT_EQ(surface.normals.size(), surface.vertices.size());
    // A ribbon is one piece: only its outline, 3 edges on each side and the foot, has no neighbour.
    EXPECT_EQ(unpaired_edges(surface), 400u * 7);
}

TEST(Tuft, BladesStartInTheDiscAndReachNoFartherThanTheyMay) {
    const Tuft tuft = grass();
    const Surface surface = tessellate(tuft);
    double mean = 0, mean_square = 0;
    for (std::size_t blade = 0; blade < tuft.blades; ++blade) {
        const Vec3* corner = &surface.vertices[blade * corners_of(tuft)];
        const Vec3 root = (corner[0] + corner[1]) * 0.5f, tip = corner[6];
        const auto aside = [](Vec3 a, Vec3 b) { return std::hypot(double{a.x} - b.x, double{a.y} - b.y); };
        EXPECT_EQ(corner[0].z, 0.25f);
        EXPECT_EQ(corner[1].z, 0.25f);
        EXPECT_LE(aside(root, tuft.center), 0.07 + 1e-6);
        EXPECT_LE(aside(root, tip), 0.12 + 1e-6);
        EXPECT_GE(aside(root, tip), 0.012 - 1e-6);
        const double width = length(corner[1] - corner[0]), height = double{tip.z} - root.z;
        EXPECT_LE(width, 0.008 + 1e-6);
        EXPECT_GE(width, 0.0048 - 1e-6);
        EXPECT_LE(height, 0.3 + 1e-6);
        EXPECT_GE(height, 0.18 - 1e-6);
        mean += height / tuft.blades;
        mean_square += aside(root, tuft.center) * aside(root, tuft.center) / tuft.blades;
    }
    // Even from 0.6 to 1 of the height; evenly in a disc, the square of the distance is half of the radius's.
    EXPECT_NEAR(mean, 0.24, 4 * 0.12 / std::sqrt(12.0 * 400));
    EXPECT_NEAR(mean_square, 0.07 * 0.07 / 2, 4 * 0.07 * 0.07 / std::sqrt(12.0 * 400));
}

TEST(Tuft, AnUprightBladeNarrowsLikeAParabola) {
    // 1 - t^2 at heights 0, 1/2, 1 is 1, 3/4, 0: two trapezia of width times height times (7/8 + 3/8) / 2.
    Tuft tuft = grass();
    tuft.blades = 1;
    tuft.segments = 2;
    tuft.reach = 1e-5f;
    const Surface surface = tessellate(tuft);
    double area = 0;
    for (const auto& [a, b, c] : surface.triangles)
        area += meshes::triangle_area(surface.vertices[a], surface.vertices[b], surface.vertices[c]);
    const double width = length(surface.vertices[1] - surface.vertices[0]),
                 height = double{surface.vertices[4].z} - surface.vertices[0].z;
    EXPECT_NEAR(area / (width * height), 0.625, 1e-4);
}

TEST(Tuft, NormalsAreSquareToTheBladeAndOnTheSideOfItsTriangles) {
    const Tuft tuft = grass();
    const Surface surface = tessellate(tuft);
    for (const auto& [a, b, c] : surface.triangles) {
        const Vec3 normal = normalize(
            cross(surface.vertices[b] - surface.vertices[a], surface.vertices[c] - surface.vertices[a]));
        for (const std::uint32_t corner : {a, b, c}) ASSERT_GT(dot(normal, surface.normals[corner]), 0.8f);
    }
    for (std::size_t blade = 0; blade < tuft.blades; ++blade) {
        const std::size_t first = blade * corners_of(tuft);
        const Vec3 across = surface.vertices[first + 1] - surface.vertices[first];
        const Vec3 chord = surface.vertices[first + 6] - (surface.vertices[first] + across * 0.5f);
        ASSERT_NEAR(dot(surface.normals[first], across), 0, 1e-6);
        ASSERT_NEAR(surface.normals[first].z, 0, 1e-6);  // A blade starts upright.
        ASSERT_GT(surface.normals[first + 6].z, 0);
        ASSERT_LT(dot(surface.normals[first], chord), 0);  // Seen from the back of the bend.
    }
}

TEST(Tuft, EachBladeIsAnotherAndTheSeedDecidesThem) {
    Tuft tuft = grass();
    const Surface surface = tessellate(tuft);
    std::set<std::pair<float, float>> tips;
    for (std::size_t blade = 0; blade < tuft.blades; ++blade) {
        const Vec3 tip = surface.vertices[(blade + 1) * corners_of(tuft) - 1];
        tips.insert({tip.x, tip.y});
    }
    EXPECT_EQ(tips.size(), 400u);
    EXPECT_EQ(tessellate(tuft).vertices, surface.vertices);
    tuft.seed = 10;
    EXPECT_NE(tessellate(tuft).vertices, surface.vertices);
    // More blades leave the first where they are.
    tuft.seed = 9;
    tuft.blades = 401;
    const Surface more = tessellate(tuft);
    EXPECT_TRUE(std::equal(surface.vertices.begin(), surface.vertices.end(), more.vertices.begin()));
}

}  // namespace
}  // namespace regather::scenes
