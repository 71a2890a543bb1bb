#include "capture/light/lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "scenes/tessellation.h"

namespace regather::capture {
namespace {

scenes::AreaLight rectangle(Vec3 corner, Vec3 edge_u, Vec3 edge_v, float radiance) {
    scenes::AreaLight light;
    light.corner = corner;
    light.edge_u = edge_u;
    light.edge_v = edge_v;
    light.radiance = {radiance, radiance, radiance};
    return light;
}

void add_mesh_light(Scene& scene, const scenes::Surface& surface, Vec3 radiance) {
    const auto base = static_cast<std::uint32_t>(scene.vertices.size());
    scenes::AreaLight light;
    light.radiance = radiance;
    light.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
    light.triangle_count = static_cast<std::uint32_t>(surface.triangles.size());
    scene.vertices.insert(scene.vertices.end(), surface.vertices.begin(), surface.vertices.end());
    scene.normals.resize(scene.vertices.size());
    double area = 0;
    for (const auto& t : surface.triangles) {
        scene.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
        scene.triangle_material.push_back(0);
        scene.triangle_light.push_back(static_cast<std::int32_t>(scene.lights.size()));
        area += scenes::triangle_area(surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]);
    }
    light.mesh_area = static_cast<float>(area);
    scene.lights.push_back(light);
    scene.materials.resize(1);
}

/// Many small lights at random places, turned any way, with powers over six decades.
Scene field_of_lights(std::uint32_t count) {
    Scene scene;
    for (std::uint32_t i = 0; i < count; ++i) {
        Sampler random(5, Stream::eye, i);
        const auto any = [&](float size) {
            return Vec3{size * (random.uniform() - 0.5f), size * (random.uniform() - 0.5f),
                        size * (random.uniform() - 0.5f)};
        };
        const Vec3 corner = any(10), u = any(1), v = any(1);
        scene.lights.push_back(rectangle(corner, u, v, std::pow(10.0f, 6 * random.uniform() - 3)));
    }
    return scene;
}

TEST(LightSampler, SharesAddUpToOneAndAreTheFrequenciesOfTheSamples) {
    for (const std::uint32_t count : {3u, 64u, 300u}) {
        const Scene scene = field_of_lights(count);
        const LightSampler lights(scene);
        View view;
        lights.look({0.3f, -0.2f, 1}, {0, 0, 1}, view);
        double sum = 0;
        for (std::uint32_t l = 0; l < count; ++l) sum += lights.share(view, l);
        EXPECT_NEAR(sum, 1, 1e-9) << count;

        std::map<std::uint32_t, int> found;
        constexpr int samples = 100000;
        Sampler random(1, Stream::shadow, count);
        for (int i = 0; i < samples; ++i) {
            LightPoint point;
            const double choice = random.fine_uniform(), u = random.fine_uniform(), v = random.fine_uniform();
            ASSERT_TRUE(lights.sample(view, choice, u, v, point));
            ++found[point.light];
            ASSERT_DOUBLE_EQ(point.pdf, lights.pdf_area(view, point.light));
        }
        // Chi-squared over the lights with 10 expected samples or more; the others are one class.
        double chi2 = 0, rest_expected = 0, rest_found = 0;
        int classes = 0;
        const auto add = [&](double expected, double observed) {
            chi2 += (observed - expected) * (observed - expected) / expected;
            ++classes;
        };
        for (std::uint32_t l = 0; l < count; ++l) {
            const double expected = samples * lights.share(view, l);
            if (expected >= 10) {
                add(expected, found[l]);
            } else {
                rest_expected += expected;
                rest_found += found[l];
            }
        }
        if (rest_expected >= 10) add(rest_expected, rest_found);
        const double freedom =
            classes - 1;  // normal beyond ten degrees of freedom: within 4 deviations, p = 6e-5
        EXPECT_LT(chi2, freedom + 4 * std::sqrt(2 * freedom) + 6) << count;
    }
}

/// Brute force: points all over a light. One that faces the point from above the horizon must have a chance.
TEST(LightSampler, OnlyLightsThatCannotReachThePointAreLeftOut) {
    const Scene scene = field_of_lights(400);
    const LightSampler lights(scene);
    View view;
    int left_out = 0, reaching = 0;
    for (int place = 0; place < 20; ++place) {
        Sampler random(9, Stream::gather, static_cast<std::uint64_t>(place));
        const Vec3 point{10 * random.uniform() - 5, 10 * random.uniform() - 5, 10 * random.uniform() - 5};
        const Vec3 side =
            normalize(Vec3{random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f});
        lights.look(point, side, view);
        for (std::uint32_t l = 0; l < lights.size(); ++l) {
            bool reaches = false;
            for (int i = 0; i < 64; ++i) {
                const LightPoint at = lights.sample_light(l, (i % 8 + 0.5) / 8, (i / 8 + 0.5) / 8);
                reaches |= dot(side, at.position - point) > 0 && dot(at.normal, point - at.position) > 0;
            }
            const double share = lights.share(view, l);
            EXPECT_TRUE(share > 0 || !reaches) << l;
            reaching += reaches;
            left_out += share == 0;
        }
    }
    EXPECT_GT(left_out, 20 * 400 / 4);  // half face away, half are below: about one in four reaches
    EXPECT_GT(reaching, 20 * 400 / 8);
}

TEST(LightSampler, ALightBehindItsPlaneOrBelowTheHorizonIsNeverTaken) {
    Scene scene;
    scene.lights = {rectangle({0, 0, 2}, {0, 1, 0}, {1, 0, 0}, 1),    // above, faces down
                    rectangle({0, 0, 2}, {1, 0, 0}, {0, 1, 0}, 1),    // above, faces up
                    rectangle({0, 0, -2}, {1, 0, 0}, {0, 1, 0}, 1)};  // below, faces up
    const LightSampler lights(scene);
    View view;
    lights.look({0.5f, 0.5f, 0}, {0, 0, 1}, view);
    EXPECT_EQ(lights.share(view, 0), 1);
    EXPECT_EQ(lights.share(view, 1), 0);
    EXPECT_EQ(lights.share(view, 2), 0);
    lights.look({0.5f, 0.5f, 0}, {}, view);  // a point without a surface is lit from below, too
    EXPECT_NEAR(lights.share(view, 0), 0.5, 1e-12);
    EXPECT_NEAR(lights.share(view, 2), 0.5, 1e-12);
    lights.look({0.5f, 0.5f, 3}, {0, 0, -1}, view);
    EXPECT_EQ(lights.share(view, 0), 0);
    lights.look({0.5f, 0.5f, -3}, {0, 0, -1}, view);
    EXPECT_TRUE(view.dark());
    LightPoint point;
    EXPECT_FALSE(lights.sample(view, 0.5, 0.5, 0.5, point));
}

/// Solid angle of a rectangle light by points chosen on it: 4 atan(ab / (d sqrt(a^2 + b^2 + d^2))) for half
/// edges a, b.
TEST(LightSampler, TheSolidAngleOfARectangleIsTheTextbookOne) {
    Scene scene;
    scene.lights = {rectangle({-0.5f, -1, 2}, {0, 2, 0}, {1, 0, 0}, 1),
                    rectangle({5, 5, 1}, {0, 2, 0}, {1, 0, 0}, 3)};
    const LightSampler lights(scene);
    View view;
    lights.look({0, 0, 0}, {0, 0, 1}, view);
    double sum = 0, squares = 0;
    constexpr int samples = 40000;
    for (int i = 0; i < samples; ++i) {
        Sampler random(2, Stream::shadow, static_cast<std::uint64_t>(i));
        LightPoint point;
        const double choice = random.fine_uniform(), u = random.fine_uniform(), v = random.fine_uniform();
        ASSERT_TRUE(lights.sample(view, choice, u, v, point));
        double value = 0;
        if (point.light == 0) {
            const double d2 = dot(point.position, point.position);
            value = -dot(point.normal, normalize(point.position)) / d2 / point.pdf;
        }
        sum += value;
        squares += value * value;
    }
    const double mean = sum / samples, error = std::sqrt((squares / samples - mean * mean) / samples);
    EXPECT_NEAR(mean, 4 * std::atan(0.5 * 1 / (2 * std::sqrt(0.25 + 1 + 4))), 4 * error);
    EXPECT_LT(error, 0.01);
}

TEST(LightSampler, PointsOfAMeshLightLieEvenlyOnItsTriangles) {
    Scene scene;
    // Two triangles in the plane z = 1, of areas 1/2 and 3/2, and a degenerate one between.
    scenes::Surface surface;
    surface.vertices = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {5, 0, 1}, {8, 0, 1}, {5, 1, 1}};
    surface.triangles = {{0, 1, 2}, {0, 1, 1}, {3, 4, 5}};
    add_mesh_light(scene, surface, {1, 1, 1});
    const LightSampler lights(scene);
    EXPECT_DOUBLE_EQ(lights.density(0), 0.5);
    double far = 0;
    std::array<double, 2> sum{};
    constexpr int side = 300;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const LightPoint point = lights.sample_light(0, (i + 0.5) / side, (j + 0.5) / side);
            EXPECT_EQ(point.position.z, 1);
            EXPECT_EQ(point.normal, (Vec3{0, 0, 1}));
            const bool second = point.position.x >= 5;
            far += second;
            if (second) {
                sum[0] += point.position.x;
                sum[1] += point.position.y;
            }
        }
    EXPECT_NEAR(far / (side * side), 0.75, 1e-3);
    EXPECT_NEAR(sum[0] / far, (5.0 + 8 + 5) / 3, 5e-3);  // the centroid
    EXPECT_NEAR(sum[1] / far, 1.0 / 3, 5e-3);
}

TEST(LightSampler, PhotonsCarryThePowerOfAllLights) {
    Scene scene;
    scene.lights = {rectangle({0, 0, 2}, {0, 1, 0}, {1, 0, 0}, 2),
                    rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0)};
    scene.lights[0].radiance = {4, 2, 0};
    add_mesh_light(scene, scenes::tessellate(scenes::Sphere{{5, 5, 5}, 0.5f, 16}), {1, 1, 1});
    const LightSampler lights(scene);
    const double sphere = scene.lights[2].mesh_area * std::numbers::pi;
    EXPECT_NEAR(lights.total_power().x, 4 * std::numbers::pi + sphere, 1e-4);
    EXPECT_NEAR(lights.total_power().z, sphere, 1e-4);

    std::array<double, 3> sum{};
    double cosine = 0;
    std::array<int, 3> counts{};
    constexpr int photons = 50000;
    for (int i = 0; i < photons; ++i) {
        Sampler random(3, Stream::photon, static_cast<std::uint64_t>(i));
        const Emission photon = lights.emit(random);
        ++counts[photon.light];
        for (int c = 0; c < 3; ++c) sum[static_cast<std::size_t>(c)] += photon.power[c];
        const float along = dot(photon.direction, photon.normal);
        ASSERT_GT(along, 0);
        cosine += along;
        if (photon.light == 2) {
            ASSERT_NEAR(length(photon.position - Vec3{5, 5, 5}), 0.5, 0.02);
            ASSERT_GT(dot(photon.normal, photon.position - Vec3{5, 5, 5}), 0.45f);
        }
    }
    EXPECT_EQ(counts[1], 0);
    EXPECT_NEAR(cosine / photons, 2.0 / 3, 4 * std::sqrt(1.0 / 18 / photons));  // of the density cos / pi
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[static_cast<std::size_t>(c)] / photons, lights.total_power()[c],
                    0.02 * lights.total_power().x);
}

TEST(LightSampler, WithoutPowerItIsDark) {
    Scene scene;
    EXPECT_TRUE(LightSampler(scene).dark());
    scene.lights = {rectangle({0, 0, 2}, {0, 1, 0}, {1, 0, 0}, 0),
                    rectangle({0, 0, 2}, {0, 1, 0}, {0, 1, 0}, 1)};
    const LightSampler lights(scene);  // black, and without area
    EXPECT_TRUE(lights.dark());
    View view;
    lights.look({0, 0, 0}, {0, 0, 1}, view);
    EXPECT_TRUE(view.dark());
    EXPECT_EQ(lights.pdf_area(view, 0), 0);
    EXPECT_EQ(lights.pdf_area(view, 1), 0);
}

}  // namespace
}  // namespace regather::capture
