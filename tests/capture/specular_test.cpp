#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "capture/capture.h"
#include "capture/query_pass.h"
#include "scenes/catalogue.h"
#include "tests/capture/small_scenes.h"

namespace regather::capture {
namespace {

/// The camera at the origin looks along +x at a surface at x = 2; a light wall faces it from x = -3.
scenes::Scene looking_at(const std::string& material) {
    return scenes::parse_scene(
        R"({"name": "mirror", "camera": {"position": [0, 0, 0], "target": [1, 0, 0], "up": [0, 0, 1],
                                           "vertical_fov_degrees": 0.01},
            "materials": {"surface": )" +
            material + R"(},
            "shapes": [{"type": "quad", "material": "surface", "corner": [2, -1, -1], "edge_u": [0, 0, 2], "edge_v": [0, 2, 0]}],
            "lights": [{"corner": [-3, -1, -1], "edge_u": [0, 2, 0], "edge_v": [0, 0, 2], "radiance": [4, 4, 4]}]})",
        "mirror.json", ".");
}

Vec3 seen(const scenes::Scene& scene) {
    const RayCaster caster(scene);
    PixelWork work;
    const LightSampler lights(scene);
    const QueryConfig config{
        .width = 1, .height = 1, .gather_rays = 4, .shadow_rays = 4, .max_specular = 8, .seed = 1};
    QueryPass(scene, caster, lights, config, {}).run(0, 1, work);
    return work.radiance[0][static_cast<std::size_t>(Layer::specular)];
}

TEST(QueryPass, AMirrorShowsTheLightBehindTheCameraTimesItsReflectance) {
    const Vec3 pixel = seen(looking_at(R"({"kind": "mirror", "specular": [0.5, 0.25, 1]})"));
    EXPECT_FLOAT_EQ(pixel.x, 2);
    EXPECT_FLOAT_EQ(pixel.y, 1);
    EXPECT_FLOAT_EQ(pixel.z, 4);
}

TEST(QueryPass, GlassAtNormalIncidenceReflectsFourPercent) {
    EXPECT_NEAR(seen(looking_at(R"({"kind": "dielectric", "index_of_refraction": 1.5})")).x, 4 * 0.04, 1e-4);
}

/// Mean radiance over an image, and its standard error.
std::pair<double, double> mean_radiance(const scenes::Scene& scene, std::uint32_t edge,
                                        std::uint32_t gather_rays) {
    CaptureConfig config;
    config.pixels = {.width = edge,
                     .height = edge,
                     .gather_rays = gather_rays,
                     .shadow_rays = 16,
                     .max_specular = 64,
                     .seed = 2};
    config.photon = {.photons = 100000, .seed = 2};
    config.gather = {.k = 1000, .radius = 0.01f};
    const Image image = capture(scene, config).image;
    double sum = 0, squares = 0;
    for (const Vec3 p : image.pixels) {
        sum += p.x;
        squares += static_cast<double>(p.x) * p.x;
    }
    const double n = static_cast<double>(image.pixels.size()), mean = sum / n;
    return {mean, std::sqrt((squares / n - mean * mean) / n)};
}

scenes::Scene furnace_with(const char* shapes) {
    std::string text;
    for (const scenes::EmbeddedScene& entry : scenes::catalogue())
        if (entry.name == "furnace") text = entry.text;
    nlohmann::json root = nlohmann::json::parse(text);
    root["materials"]["glass"] = {{"kind", "dielectric"}, {"index_of_refraction", 1.5}};
    root["materials"]["silver"] = {{"kind", "mirror"}, {"specular", {1, 1, 1}}};
    root["shapes"] = nlohmann::json::parse(shapes);
    root["camera"] = {{"position", {0.5, 0.5, 0.5}},
                      {"target", {0.5, 1, 0.5}},
                      {"up", {0, 0, 1}},
                      {"vertical_fov_degrees", 30}};
    return scenes::parse_scene(root.dump(), "furnace.json", ".");
}

TEST(QueryPass, ASlabOfGlassPassesWhatTheSeriesOfItsReflectionsSays) {
    // (1 - R)^2 (1 + R^2 + R^4 ...) = (1 - R) / (1 + R), R = 0.04 at each face.
    const scenes::Scene slab = scenes::parse_scene(
        R"({"name": "slab", "camera": {"position": [0, 0, 0], "target": [1, 0, 0], "up": [0, 0, 1], "vertical_fov_degrees": 0.01},
            "materials": {"glass": {"kind": "dielectric", "index_of_refraction": 1.5}},
            "shapes": [{"type": "box", "material": "glass", "min": [1, -1, -1], "max": [1.2, 1, 1]}],
            "lights": [{"corner": [2, -1, -1], "edge_u": [0, 0, 2], "edge_v": [0, 2, 0], "radiance": [4, 4, 4]}]})",
        "slab.json", ".");
    const auto [mean, error] = mean_radiance(slab, 128, 0);
    EXPECT_NEAR(mean, 4 * 0.96 / 1.04, 4 * error);
    EXPECT_LT(error, 0.02);
}

TEST(QueryPass, GlassAndMirrorBallsInAFurnaceCannotBeSeen) {
    const auto [mean, error] = mean_radiance(
        furnace_with(
            R"([{"type": "sphere", "material": "glass", "center": [0.5, 0.75, 0.5], "radius": 0.1, "segments": 32},
                         {"type": "sphere", "material": "silver", "center": [0.35, 0.7, 0.5], "radius": 0.04, "segments": 32}])"),
        32, 64);
    EXPECT_NEAR(mean, 2, 4 * error + 0.01);  // 0.5 %: photons share their noise among the pixels
    EXPECT_LT(error, 0.02);
}

TEST(QueryPass, InsideGlassRadianceIsLargerByTheSquareOfTheIndex) {
    const auto [mean, error] = mean_radiance(
        furnace_with(
            R"([{"type": "box", "material": "glass", "min": [0.05, 0.05, 0.05], "max": [0.95, 0.95, 0.95]}])"),
        32, 64);
    EXPECT_NEAR(mean, 1.5 * 1.5 * 2, 4 * error + 0.0225);
    EXPECT_LT(error, 0.05);
}

}  // namespace
}  // namespace regather::capture
