// The photon mapper against our own path tracer, which shares scene, materials and lights with it and nothing
// of the estimate.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "capture/capture.h"
#include "capture/reference/path_tracer.h"
#include "scenes/loader.h"

namespace regather::capture {
namespace {

struct Mean {
    double value, error;  ///< Of the mean over the picture, and its standard error.
};

Mean over(const std::vector<double>& values) {
    double mean = 0, squares = 0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    for (const double value : values) squares += (value - mean) * (value - mean);
    const double n = static_cast<double>(values.size());
    return {mean, std::sqrt(squares / (n - 1) / n)};
}

Mean by_photons(const scenes::Scene& scene, CaptureConfig config, int seeds) {
    std::vector<double> means;
    for (int seed = 1; seed <= seeds; ++seed) {
        config.pixels.seed = config.photon.seed = static_cast<std::uint64_t>(seed);
        const Image image = capture(scene, config).image;
        double sum = 0;
        for (const Vec3 p : image.pixels) sum += luminance(p);
        means.push_back(sum / static_cast<double>(image.pixels.size()));
    }
    return over(means);
}

Mean by_paths(const scenes::Scene& scene, std::uint32_t edge, std::uint32_t samples, int seeds) {
    const RayCaster caster(scene);
    const LightSampler lights(scene);
    std::vector<double> means;
    for (int seed = 1; seed <= seeds; ++seed) {
        const PathTracer tracer(scene, caster, lights,
                                {.width = edge, .height = edge, .seed = static_cast<std::uint64_t>(seed)});
        std::vector<Moments> pixels(std::size_t{edge} * edge);
        tracer.add(pixels, 0, samples);
        double sum = 0;
        for (const Moments& pixel : pixels)
            sum += 0.2126 * pixel.mean[0] + 0.7152 * pixel.mean[1] + 0.0722 * pixel.mean[2];
        means.push_back(sum / static_cast<double>(pixels.size()));
    }
    return over(means);
}

CaptureConfig small_radius(std::uint32_t edge) {
    CaptureConfig config;
    config.pixels = {
        .width = edge, .height = edge, .gather_rays = 32, .shadow_rays = 8, .max_specular = 32, .samples = 4};
    config.photon.photons = 100'000;
    config.gather = {.k = 1000, .radius = 0.02f};
    config.caustic = {.photons = 100'000, .k = 10'000, .radius = 0.03f, .filter = Filter::none};
    return config;
}

/// Student's t, 8 seeds each: 4.5 combined standard errors are exceeded once in a few thousand times by
/// chance; `bias` is what a gather of that radius may lose at edges and corners, as a share of the mean.
void expect_equal(const Mean& photons, const Mean& paths, double bias) {
    const double interval = 4.5 * std::hypot(photons.error, paths.error);
    EXPECT_LT(interval, 0.05 * paths.value) << "the interval is too wide to say anything";
    testing::Test::RecordProperty("photons", std::to_string(photons.value));
    testing::Test::RecordProperty("paths", std::to_string(paths.value));
    EXPECT_NEAR(photons.value, paths.value, interval + bias * paths.value);
}

TEST(Agreement, TheCornellBoxIsAsBrightByPhotonsAsByPaths) {
    scenes::Scene scene = scenes::load_scene("cornell");
    scene.camera.vertical_fov_degrees = 22;  // the light, which would drown all else, is out of sight
    CaptureConfig config = small_radius(12);
    config.gather.radius = 0.01f;
    expect_equal(by_photons(scene, config, 8), by_paths(scene, 12, 200, 8), 0.01);
}

TEST(Agreement, GlossAndCausticsAreAsBrightByPhotonsAsByPaths) {
    // A closed room with a glossy floor, a mirror and a glass ball under a large light.
    const scenes::Scene scene = scenes::parse_scene(
        R"({"name": "ball", "camera": {"position": [0.5, 0.05, 0.6], "target": [0.5, 1, 0.3], "up": [0, 0, 1], "vertical_fov_degrees": 70},
            "materials": {"wall": {"kind": "diffuse", "diffuse": [0.6, 0.5, 0.4]},
                          "lacquer": {"kind": "glossy", "diffuse": [0.3, 0.3, 0.3], "specular": [0.4, 0.4, 0.4], "exponent": 200},
                          "silver": {"kind": "mirror", "specular": [0.9, 0.9, 0.9]},
                          "glass": {"kind": "dielectric", "index_of_refraction": 1.5}},
            "shapes": [
              {"type": "quad", "material": "lacquer", "corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0]},
              {"type": "quad", "material": "wall", "corner": [0, 0, 1], "edge_u": [0, 1, 0], "edge_v": [1, 0, 0]},
              {"type": "quad", "material": "wall", "corner": [0, 0, 0], "edge_u": [0, 0, 1], "edge_v": [1, 0, 0]},
              {"type": "quad", "material": "wall", "corner": [0, 1, 0], "edge_u": [1, 0, 0], "edge_v": [0, 0, 1]},
              {"type": "quad", "material": "silver", "corner": [0, 0, 0], "edge_u": [0, 1, 0], "edge_v": [0, 0, 1]},
              {"type": "quad", "material": "wall", "corner": [1, 0, 0], "edge_u": [0, 0, 1], "edge_v": [0, 1, 0]},
              {"type": "sphere", "material": "glass", "center": [0.55, 0.6, 0.25], "radius": 0.2, "segments": 48}],
            "lights": [{"corner": [0.2, 0.2, 0.99], "edge_u": [0, 0.6, 0], "edge_v": [0.6, 0, 0], "power": [10, 10, 10]}]})",
        "ball.json", ".");
    expect_equal(by_photons(scene, small_radius(12), 8), by_paths(scene, 12, 400, 8), 0.01);
}

}  // namespace
}  // namespace regather::capture
