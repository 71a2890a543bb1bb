#include "capture/reference/path_tracer.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "scenes/catalogue.h"
#include "scenes/tessellation.h"
#include "tests/capture/small_scenes.h"

namespace regather::capture {
namespace {

constexpr double pi = std::numbers::pi;

/// Mean over all pixels and samples, and its standard error, by channel.
struct Estimate {
    std::array<double, 3> mean{}, error{};
    PathCounts counts;
};

Estimate estimate(const Scene& scene, std::uint32_t edge, std::uint32_t samples, PathConfig config = {}) {
    const RayCaster caster(scene);
    const LightSampler lights(scene);
    config.width = config.height = edge;
    std::vector<Moments> pixels(std::size_t{edge} * edge);
    Estimate all;
    all.counts = PathTracer(scene, caster, lights, config).add(pixels, 0, samples);
    for (std::size_t c = 0; c < 3; ++c) {
        for (const Moments& pixel : pixels) {
            all.mean[c] += pixel.mean[c];
            all.error[c] += pixel.variance(c, samples);
        }
        all.mean[c] /= static_cast<double>(pixels.size());
        all.error[c] = std::sqrt(all.error[c]) / static_cast<double>(pixels.size());
    }
    return all;
}

/// z-test on one channel. |z| < 4.2 has p = 2.7e-5; the file has about thirty of them: together below 1e-3 of
/// failing by chance, and the seeds are fixed. `exact`: relative error of the expected value itself. The test
/// can see errors above `sees`.
void expect_mean(const Estimate& found, std::size_t channel, double expected, double sees, double exact = 0) {
    EXPECT_NEAR(found.mean[channel], expected, 4.2 * found.error[channel] + (exact + 1e-12) * expected);
    EXPECT_LT(4.2 * found.error[channel], sees * expected);
    EXPECT_EQ(found.counts.cut_off, 0u);
    EXPECT_EQ(found.counts.nonfinite.total(), 0u);
}

constexpr DirectLight all_ways[] = {DirectLight::both, DirectLight::lights_only, DirectLight::paths_only};

scenes::Scene furnace_with(const nlohmann::json& shapes, const nlohmann::json& wall = {}) {
    std::string text;
    for (const scenes::EmbeddedScene& entry : scenes::catalogue())
        if (entry.name == "furnace") text = entry.text;
    nlohmann::json root = nlohmann::json::parse(text);
    if (!wall.is_null()) root["materials"]["half"] = wall;
    if (!shapes.is_null()) {
        root["materials"]["glass"] = {{"kind", "dielectric"}, {"index_of_refraction", 1.5}};
        root["materials"]["silver"] = {{"kind", "mirror"}, {"specular", {1, 1, 1}}};
        root["shapes"] = shapes;
    }
    root["camera"] = {{"position", {0.5, 0.5, 0.5}},
                      {"target", {0.5, 1, 0.5}},
                      {"up", {0, 0, 1}},
                      {"vertical_fov_degrees", 30}};
    return scenes::parse_scene(root.dump(), "furnace.json", ".");
}

/// Emission 1, albedo 1/2 on all walls: 1 / (1 - 1/2).
TEST(PathTracer, AFurnaceHasTheSameRadianceEverywhere) {
    for (const DirectLight way : all_ways) {
        const Estimate found = estimate(furnace_with({}), 16, way == DirectLight::lights_only ? 512 : 128,
                                        {.direct_light = way});
        for (std::size_t c = 0; c < 3; ++c) expect_mean(found, c, 2, 0.06);
    }
}

/// One channel a stiff albedo each; the roundings of floats would show in the last one. Paths have some
/// 10,000 surfaces.
TEST(PathTracer, AClosedBoxIsAsBrightAsTheSeriesOfItsReflections) {
    const float albedo[3] = {0.9f, 0.99f, 0.999f};
    const Scene box = furnace_with({}, {{"kind", "diffuse"}, {"diffuse", {albedo[0], albedo[1], albedo[2]}}});
    const Estimate found = estimate(box, 8, 8, {.direct_light = DirectLight::paths_only});
    for (std::size_t c = 0; c < 3; ++c) expect_mean(found, c, 1 / (1 - static_cast<double>(albedo[c])), 0.1);
    const Scene stiff = furnace_with({}, {{"kind", "diffuse"}, {"diffuse", {0.9999, 0.9999, 0.9999}}});
    expect_mean(estimate(stiff, 4, 4, {.direct_light = DirectLight::paths_only}), 0,
                1 / (1 - static_cast<double>(0.9999f)), 0.3);
}

TEST(PathTracer, ABoxThatAbsorbsNothingIsCutOffAndSaysSo) {
    const Scene box = furnace_with({}, {{"kind", "diffuse"}, {"diffuse", {1, 1, 1}}});
    const RayCaster caster(box);
    const LightSampler lights(box);
    std::vector<Moments> pixels(4);
    const PathCounts counts =
        PathTracer(box, caster, lights,
                   {.width = 2, .height = 2, .direct_light = DirectLight::paths_only, .most_surfaces = 100})
            .add(pixels, 0, 3);
    EXPECT_EQ(counts.cut_off, 12u);
    EXPECT_EQ(pixels[0].mean[0], 100);  // emission 1 at each of 100 surfaces
}

/// 100 mirrors in a row and more: the roulette of specular paths does not darken them.
TEST(PathTracer, ABoxOfMirrorsIsAsBrightAsTheSeriesOfItsReflections) {
    const float reflectance = 0.99f;
    const Scene box =
        furnace_with({}, {{"kind", "mirror"}, {"specular", {reflectance, reflectance, reflectance}}});
    expect_mean(estimate(box, 32, 16), 0, 1 / (1 - static_cast<double>(reflectance)), 0.1);
}

TEST(PathTracer, GlassAndMirrorBallsInAFurnaceCannotBeSeen) {
    const Scene balls = furnace_with({{{"type", "sphere"},
                                       {"material", "glass"},
                                       {"center", {0.5, 0.75, 0.5}},
                                       {"radius", 0.1},
                                       {"segments", 32}},
                                      {{"type", "sphere"},
                                       {"material", "silver"},
                                       {"center", {0.35, 0.7, 0.5}},
                                       {"radius", 0.04},
                                       {"segments", 32}}});
    expect_mean(estimate(balls, 16, 256), 0, 2, 0.02);
}

TEST(PathTracer, InsideGlassRadianceIsLargerByTheSquareOfTheIndex) {
    const Scene inside = furnace_with(
        {{{"type", "box"}, {"material", "glass"}, {"min", {0.05, 0.05, 0.05}}, {"max", {0.95, 0.95, 0.95}}}});
    expect_mean(estimate(inside, 16, 128), 0, 1.5 * 1.5 * 2, 0.02);
}

/// (1 - R)^2 (1 + R^2 + ...) = (1 - R) / (1 + R), with R = 0.04 at each face.
TEST(PathTracer, ASlabOfGlassPassesWhatTheSeriesOfItsReflectionsSays) {
    const Scene slab = scenes::parse_scene(
        R"({"name": "slab", "camera": {"position": [0, 0, 0], "target": [1, 0, 0], "up": [0, 0, 1], "vertical_fov_degrees": 0.01},
            "materials": {"glass": {"kind": "dielectric", "index_of_refraction": 1.5}},
            "shapes": [{"type": "box", "material": "glass", "min": [1, -1, -1], "max": [1.2, 1, 1]}],
            "lights": [{"corner": [2, -1, -1], "edge_u": [0, 0, 2], "edge_v": [0, 2, 0], "radiance": [4, 4, 4]}]})",
        "slab.json", ".");
    expect_mean(estimate(slab, 64, 16), 0, 4 * 0.96 / 1.04, 0.01);
}

/// The floor under the middle of a light of 1 x 1 m, 1 m above: the form factor of a parallel rectangle, four
/// times that of its quarter with a corner overhead (Howell, "A Catalog of Radiation Heat Transfer
/// Configuration Factors", B-3).
TEST(PathTracer, TheFloorUnderARectangleHasTheRadianceOfItsFormFactor) {
    const double a = 0.5, s = std::sqrt(1 + a * a);
    const double form = 4 / (2 * pi) * (a / s * std::atan(a / s) + a / s * std::atan(a / s));
    for (const DirectLight way : all_ways) {
        const Estimate found = estimate(light_over_floor(), 32, 64, {.direct_light = way});
        expect_mean(found, 0, 0.8 * 10 * form, 0.05);
        expect_mean(found, 2, 0.2 * 10 * form, 0.05);
    }
}

/// A sphere light of radius r at (0, 0, d) over the plane z = 0, and a camera that looks at one point of it.
Scene sphere_over_plane(double x, float radius, std::uint32_t segments) {
    Scene scene = scenes::parse_scene(
        R"({"name": "sphere", "camera": {"position": [0, -1, 0.2], "target": [0, 0, 0], "up": [0, 0, 1], "vertical_fov_degrees": 0.01},
            "materials": {"floor": {"kind": "diffuse", "diffuse": [0.5, 0.5, 0.5]}, "black": {"kind": "diffuse", "diffuse": [0, 0, 0]}},
            "shapes": [{"type": "quad", "material": "floor", "corner": [-9, -9, 0], "edge_u": [18, 0, 0], "edge_v": [0, 18, 0]}],
            "lights": []})",
        "sphere.json", ".");
    scene.camera.position.x = scene.camera.target.x = static_cast<float>(x);
    const scenes::Surface ball = scenes::tessellate(scenes::Sphere{{0, 0, 2}, radius, segments});
    scenes::AreaLight light;
    light.radiance = {3, 3, 3};
    light.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
    light.triangle_count = static_cast<std::uint32_t>(ball.triangles.size());
    const auto base = static_cast<std::uint32_t>(scene.vertices.size());
    scene.vertices.insert(scene.vertices.end(), ball.vertices.begin(), ball.vertices.end());
    if (!scene.normals.empty()) scene.normals.resize(scene.vertices.size());
    double area = 0;
    for (const auto& t : ball.triangles) {
        scene.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
        scene.triangle_material.push_back(1);
        scene.triangle_light.push_back(static_cast<std::int32_t>(scene.lights.size()));
        area += scenes::triangle_area(ball.vertices[t[0]], ball.vertices[t[1]], ball.vertices[t[2]]);
    }
    light.mesh_area = static_cast<float>(area);
    scene.lights.push_back(light);
    return scene;
}

/// E = L pi (r / D)^2 cos: exact for a whole sphere above the horizon. The ball of triangles is smaller than
/// the sphere: an inscribed polyhedron's silhouette lacks at most 1 - cos^2(pi / segments) or so.
TEST(PathTracer, ASphereLightGivesAPlaneItsAnalyticIrradiance) {
    for (const double x : {0.0, 1.5}) {
        const double distance2 = x * x + 4, cosine = 2 / std::sqrt(distance2);
        const double radiance = 0.5 / pi * (3 * pi * (0.25 / distance2) * cosine);
        const double missing = 2 * std::pow(pi / 96, 2);
        for (const DirectLight way : {DirectLight::both, DirectLight::lights_only})
            expect_mean(estimate(sphere_over_plane(x, 0.5f, 96), 16, 128, {.direct_light = way}), 0, radiance,
                        0.05, missing);
        expect_mean(
            estimate(sphere_over_plane(x, 0.5f, 96), 16, 512, {.direct_light = DirectLight::paths_only}), 0,
            radiance, 0.15, missing);
    }
}

/// A glossy table under a small near and a large far light: the three ways agree, and weighing both is better
/// than the worse.
TEST(PathTracer, LightsPathsAndBothHaveTheSameMeanOnGlossySurfaces) {
    for (const int exponent : {5, 200, 20000}) {
        const Scene scene = scenes::parse_scene(
            fmt::format(
                R"({{"name": "glossy", "camera": {{"position": [0, -2, 1], "target": [0, 0, 0], "up": [0, 0, 1],
                             "vertical_fov_degrees": 40}},
                             "materials": {{"table": {{"kind": "glossy", "diffuse": [0.2, 0.3, 0.1], "specular": [0.6, 0.4, 0.5],
                                                       "exponent": {}}}}},
                             "shapes": [{{"type": "quad", "material": "table", "corner": [-2, -2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 4, 0]}},
                                        {{"type": "quad", "material": "table", "corner": [-2, 2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 0, 3]}}],
                             "lights": [{{"corner": [-0.15, 0.5, 0.6], "edge_u": [0, 0, 0.3], "edge_v": [0.3, 0, 0.1], "radiance": [9, 9, 9]}},
                                        {{"corner": [-2, -2, 3], "edge_u": [0, 4, 0], "edge_v": [4, 0, 0], "radiance": [1, 1, 1]}}]}})",
                exponent),
            "glossy.json", ".");
        Estimate found[3];
        for (std::size_t way = 0; way < 3; ++way)
            found[way] = estimate(scene, 24, 144, {.seed = way + 1, .direct_light = all_ways[way]});
        for (std::size_t way = 1; way < 3; ++way)
            for (std::size_t c = 0; c < 3; ++c) {
                const double error = std::hypot(found[0].error[c], found[way].error[c]);
                EXPECT_NEAR(found[0].mean[c], found[way].mean[c], 4.2 * error) << exponent << " " << way;
                // Points on lights miss narrow lobes: their spread is told too small there, so that only that
                // of paths is a claim.
                EXPECT_TRUE(way == 1 || found[0].error[c] < 1.1 * found[way].error[c]) << exponent;
            }
        EXPECT_LT(found[0].error[0], 0.01 * found[0].mean[0]) << exponent;
    }
}

TEST(PathTracer, AMirrorShowsTheLightBehindTheCameraTimesItsReflectance) {
    const Scene scene = scenes::parse_scene(
        R"({"name": "mirror", "camera": {"position": [0, 0, 0], "target": [1, 0, 0], "up": [0, 0, 1], "vertical_fov_degrees": 0.01},
            "materials": {"surface": {"kind": "mirror", "specular": [0.5, 0.25, 1]}},
            "shapes": [{"type": "quad", "material": "surface", "corner": [2, -1, -1], "edge_u": [0, 0, 2], "edge_v": [0, 2, 0]}],
            "lights": [{"corner": [-3, -1, -1], "edge_u": [0, 2, 0], "edge_v": [0, 0, 2], "radiance": [4, 4, 4]}]})",
        "mirror.json", ".");
    const Estimate found = estimate(scene, 4, 4);
    EXPECT_DOUBLE_EQ(found.mean[0], 2);
    EXPECT_DOUBLE_EQ(found.mean[1], 1);
    EXPECT_DOUBLE_EQ(found.mean[2], 4);
}

TEST(PathTracer, AWholeNumberOfSamplesIsTheSumOfItsPartsToTheLastBit) {
    const Scene scene = closed_box(0.7);
    const RayCaster caster(scene);
    const LightSampler lights(scene);
    const PathTracer tracer(scene, caster, lights, {.width = 20, .height = 15, .seed = 7});
    std::vector<Moments> once(300), parts(300), alone(300);
    const PathCounts all = tracer.add(once, 0, 8);
    PathCounts sum = tracer.add(parts, 0, 3);
    sum += tracer.add(parts, 3, 5);
    EXPECT_EQ(once, parts);
    EXPECT_EQ(all, sum);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(tracer.add(alone, 0, 8), all);
    EXPECT_EQ(once, alone);
    std::vector<Moments> other(300);
    PathTracer(scene, caster, lights, {.width = 20, .height = 15, .seed = 8}).add(other, 0, 8);
    EXPECT_NE(once, other);
}

TEST(PathTracer, ALightThatIsNoNumberIsCountedAndStaysBlack) {
    Scene scene = light_over_floor();
    scene.lights[0].radiance.y = std::numeric_limits<float>::quiet_NaN();
    const RayCaster caster(scene);
    const LightSampler lights(scene);
    std::vector<Moments> pixels(16);
    const PathCounts counts =
        PathTracer(scene, caster, lights, {.width = 4, .height = 4, .direct_light = DirectLight::paths_only})
            .add(pixels, 0, 64);
    EXPECT_GT(counts.nonfinite.of(Stage::path), 0u);
    for (const Moments& pixel : pixels)
        for (const double mean : pixel.mean) EXPECT_TRUE(std::isfinite(mean));
}

}  // namespace
}  // namespace regather::capture
