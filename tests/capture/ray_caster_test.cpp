#include "capture/ray_caster.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "capture/light/bsdf.h"
#include "capture/nonfinite.h"

namespace regather::capture {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();

/// Two triangles in the plane z = height: the square [-1, 1]^2, facing up, in units of `scale`, moved by
/// `shift`.
Scene square(float scale = 1, Vec3 shift = {}, float height = 0) {
    Scene scene;
    scene.materials.resize(1);
    for (const Vec3 v : {Vec3{-1, -1, height}, Vec3{1, -1, height}, Vec3{1, 1, height}, Vec3{-1, 1, height}})
        scene.vertices.push_back(v * scale + shift);
    scene.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.triangle_material = {0, 0};
    scene.triangle_light = {-1, -1};
    return scene;
}

TEST(RayCaster, HitsAreWhereGeometrySays) {
    const Scene scene = square(1, {}, 0.5f);
    const RayCaster caster(scene);
    const auto hit = caster.closest({0.25f, -0.5f, 2}, {0, 0, -1});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance, 1.5f, 1e-6f);
    EXPECT_EQ(hit->triangle, 0u);
    EXPECT_NEAR(hit->position.x, 0.25f, 1e-7f);
    EXPECT_NEAR(hit->position.y, -0.5f, 1e-7f);
    EXPECT_EQ(hit->position.z, 0.5f);
    EXPECT_EQ(hit->geometric_normal, (Vec3{0, 0, 1}));
    EXPECT_FALSE(caster.closest({0.25f, -0.5f, 2}, {0, 0, 1}));
    EXPECT_TRUE(caster.occluded({0, 0.25f, 2}, {0, 0, -1}, 1.6f));
    EXPECT_FALSE(caster.occluded({0, 0.25f, 2}, {0, 0, -1}, 1.4f));
}

TEST(RayCaster, RaysThatAreNoneHitNothing) {
    const Scene scene = square();
    const RayCaster caster(scene);
    for (const Vec3 direction : {Vec3{}, Vec3{nan, 0, -1}, Vec3{0, 0, -infinity}, Vec3{0, nan, nan}}) {
        EXPECT_FALSE(caster.closest({0, 0.2f, 1}, direction));
        EXPECT_FALSE(caster.occluded({0, 0.2f, 1}, direction, 10));
    }
    for (const Vec3 origin : {Vec3{nan, 0, 1}, Vec3{0, infinity, 1}}) {
        EXPECT_FALSE(caster.closest(origin, {0, 0, -1}));
        EXPECT_FALSE(caster.occluded(origin, {0, 0, -1}, 10));
    }
    for (const float extent : {0.0f, -1.0f, nan})
        EXPECT_FALSE(caster.occluded({0, 0.2f, 1}, {0, 0, -1}, extent));
}

TEST(RayCaster, AnEmptySceneHasNoHits) {
    const Scene scene;
    const RayCaster caster(scene);
    EXPECT_FALSE(caster.closest({}, {0, 0, 1}));
    EXPECT_FALSE(caster.occluded({}, {0, 0, 1}, 1));
}

TEST(RayCaster, TrianglesWithoutAreaAreNeverHit) {
    Scene scene = square();
    scene.vertices.push_back({0, 0, 1});
    scene.vertices.push_back({0.3f, 0.1f, 1});
    scene.vertices.push_back({0.6f, 0.2f, 1});
    for (const auto& triangle : {std::array<std::uint32_t, 3>{4, 4, 4}, {4, 5, 5}, {4, 4, 6}})
        scene.triangles.push_back(triangle);
    scene.triangle_material.resize(5);
    scene.triangle_light.resize(5, -1);
    const RayCaster caster(scene);
    for (int i = 0; i <= 30; ++i) {
        const float x = 0.02f * static_cast<float>(i);
        const auto hit = caster.closest({x, x / 3, 2}, {0, 0, -1});
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->position.z, 0);
        EXPECT_TRUE(is_finite(hit->geometric_normal));
    }
}

// Edges of 1e-10: the square of the area is 1e-40, no float.
TEST(RayCaster, NormalsOfTinyTrianglesHaveUnitLength) {
    const Scene scene = square(1e-10f);
    const RayCaster caster(scene);
    const auto hit = caster.closest({2e-11f, 1e-11f, 1e-10f}, {0, 0, -1});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(length(hit->geometric_normal), 1, 1e-6f);
    EXPECT_EQ(hit->geometric_normal.z, 1);
}

TEST(RayCaster, OffsetsScaleWithTheScene) {
    const Vec3 normal = normalize(Vec3{1, 2, 3});
    for (const float scale : {0x1p-20f, 1.0f, 0x1p20f}) {
        const Scene scene = square(scale);
        const RayCaster caster(scene);
        const Vec3 step =
            caster.offset(Vec3{0.25f, -0.5f, 0.125f} * scale, normal) - Vec3{0.25f, -0.5f, 0.125f} * scale;
        const float height = dot(step, normal) / scale;
        EXPECT_GT(
            height,
            0x1p-18f);  // of the scene's extent, which is 2: twice the errors that docs/stability.md adds up
        EXPECT_LT(height, 0x1p-16f);
        EXPECT_LE(length(step) / scale, 0x1p-17f * 1.01f);  // 2^-18 of that extent
        EXPECT_LT(length(cross(step * (1 / length(step)), normal)), 1e-2f);
    }
}

// 1000 of its sizes away a coordinate's neighbours are 2^-14 apart: a step in floats, not a share of the
// size.
TEST(RayCaster, OffsetsFarFromTheOriginAreManyFloats) {
    const Scene scene = square(1, {1000, 1000, 1000});
    const RayCaster caster(scene);
    const Vec3 up = caster.offset({1000, 1000, 1000}, {0, 0, 1}),
               down = caster.offset({1000, 1000, 1000}, {0, 0, -1});
    EXPECT_EQ(up.z, 1000 + 64 * 0x1p-14f);
    EXPECT_EQ(down.z, 1000 - 64 * 0x1p-14f);
    EXPECT_EQ(up.x, 1000);
    const Scene mirrored = square(1, {-1000, -1000, -1000});
    EXPECT_EQ(RayCaster(mirrored).offset({-1000, -1000, -1000}, {0, 0, 1}).z, -1000 + 64 * 0x1p-14f);
}

/// Points of the square at all angles: a ray that leaves from the offset point must not meet the square
/// again.
TEST(RayCaster, RaysFromOffsetPointsDoNotMeetTheirOwnSurface) {
    for (const float scale : {1e-6f, 1.0f, 1e6f})
        for (const float tilt : {0.0f, 0.3f, 1.2f}) {
            Scene scene = square(scale);
            for (Vec3& v : scene.vertices)
                v = {v.x * std::cos(tilt), v.y, v.x * std::sin(tilt) + 0.7f * scale};
            const RayCaster caster(scene);
            int own = 0;
            for (std::uint64_t i = 0; i < 20'000; ++i) {
                Sampler sampler(1, Stream::eye, i);
                const float x = 1.98f * sampler.uniform() - 0.99f, y = 1.98f * sampler.uniform() - 0.99f;
                const Vec3 target = Vec3{x * std::cos(tilt), y, x * std::sin(tilt) + 0.7f} * scale;
                const Vec3 from{3 * scale, 2 * scale, 9 * scale};
                const auto hit = caster.closest(from, normalize(target - from));
                ASSERT_TRUE(hit);
                const Vec3 side = dot(hit->geometric_normal, from - target) > 0 ? hit->geometric_normal
                                                                                : -hit->geometric_normal;
                // From grazing to straight up.
                const float u = sampler.uniform(), height = u * u * u * u;
                const Vec3 away =
                    Frame(side).to_world({std::sqrt(1 - height * height) * std::cos(6.28f * y),
                                          std::sqrt(1 - height * height) * std::sin(6.28f * y), height});
                own += caster.closest(caster.offset(hit->position, side), normalize(away)).has_value() &&
                       height > 1e-6f;
                own += caster.occluded(caster.offset(hit->position, side), normalize(away), 100 * scale) &&
                       height > 1e-6f;
            }
            EXPECT_EQ(own, 0) << scale << " " << tilt;
        }
}

TEST(RayCaster, HitsNextToAnEdgeLieInsideIt) {
    const Scene scene = square();
    const RayCaster caster(scene);
    const auto hit = caster.closest({0.999999f, 0.5f, 1}, {0, 0, -1});
    ASSERT_TRUE(hit);
    EXPECT_LT(hit->position.x, 1 - caster.inset() / 4);
    EXPECT_LE(length(hit->position - Vec3{0.999999f, 0.5f, 0}), caster.inset() * 1.01f);
    const auto middle = caster.closest({0.5f, 0.25f, 1}, {0, 0, -1});
    ASSERT_TRUE(middle);
    EXPECT_LT(length(middle->position - Vec3{0.5f, 0.25f, 0}), 1e-6f);
}

TEST(RayCaster, ASurfaceThroughTheOriginIsNotHit) {
    Scene scene = square();
    const Scene above = square(1, {}, 1);
    for (const Vec3 v : above.vertices) scene.vertices.push_back(v);
    scene.triangles.push_back({4, 5, 6});
    scene.triangles.push_back({4, 6, 7});
    scene.triangle_material.resize(4);
    scene.triangle_light.resize(4, -1);
    const RayCaster caster(scene);
    const auto hit = caster.closest({0.1f, 0.2f, 0}, normalize(Vec3{0.1f, 0.2f, 1}));
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->position.z, 1);
}

// The corner where four of eight triangles meet, from 20,000 points: a ray at it must not slip through.
TEST(RayCaster, NoRaySlipsThroughAVertex) {
    Scene scene;
    scene.materials.resize(1);
    const Vec3 n = normalize(Vec3{1, 2, 3});
    const Frame frame(n);
    constexpr std::uint32_t spokes = 7;
    scene.vertices.push_back({});
    for (std::uint32_t i = 0; i < spokes; ++i) {
        const float angle = 6.2831853f * static_cast<float>(i) / spokes;
        scene.vertices.push_back(frame.to_world({std::cos(angle), std::sin(angle), 0.5f}));
    }
    scene.vertices.push_back(n * -3.0f);  // makes the box hold the origins
    for (std::uint32_t i = 0; i < spokes; ++i) scene.triangles.push_back({0, 1 + i, 1 + (i + 1) % spokes});
    scene.triangle_material.resize(spokes);
    scene.triangle_light.resize(spokes, -1);
    const RayCaster caster(scene);
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        Sampler sampler(2, Stream::eye, i);
        const float u = sampler.uniform();
        const Vec3 from = frame.to_world(cosine_hemisphere(u, sampler.uniform())) * 0.9f;
        if (dot(from, n) > 0.5f) {
            EXPECT_TRUE(caster.closest(from, normalize(-from))) << i;
        }
    }
}

// Embree advises programs to flush denormals to zero; neither it nor TBB may do so behind our back, as
// results would then depend on which thread made them.
TEST(RayCaster, NoThreadFlushesDenormals) {
    const Scene scene = square();
    const RayCaster caster(scene);
    ASSERT_TRUE(caster.occluded({0, 0.2f, 1}, {0, 0, -1}, 10));
    std::atomic<int> flushed{0};
    tbb::parallel_for(0, 1000, [&](int i) {
        volatile float tiny = 0x1p-130f * static_cast<float>(1 + i);
        tiny = tiny * 0.5f;
        flushed += tiny == 0;
    });
    EXPECT_EQ(flushed, 0);
}

TEST(Nonfinite, ValuesAreReplacedCountedAndTold) {
    Nonfinite faults;
    EXPECT_EQ(faults.checked(Stage::shadow, Vec3{1, 2, 3}), (Vec3{1, 2, 3}));
    EXPECT_EQ(faults.total(), 0u);
    EXPECT_EQ(faults.text(), "");
    EXPECT_EQ(faults.checked(Stage::shadow, Vec3{1, nan, 3}), Vec3{});
    EXPECT_EQ(faults.checked(Stage::photon, infinity), 0);
    EXPECT_EQ(faults.checked(Stage::photon, 2.0f), 2);
    Nonfinite more;
    more.count(Stage::shadow);
    faults += more;
    EXPECT_EQ(faults.of(Stage::shadow), 2u);
    EXPECT_EQ(faults.total(), 3u);
    EXPECT_EQ(faults.text(), "3 values were not finite and became 0: photon 1, shadow 2");
}

}  // namespace
}  // namespace regather::capture
