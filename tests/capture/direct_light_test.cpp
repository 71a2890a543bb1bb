// Direct light on a glossy floor, looked for by shadow rays and by gather rays both: whatever the number of
// either, their weights add up to the integral over the lights.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "capture/capture.h"
#include "capture/light/bsdf.h"
#include "capture/reference/moments.h"
#include "scenes/loader.h"

namespace regather::capture {
namespace {

const Vec3 eye{0.9f, 0, 0.5f};
constexpr double height = 0.4, emitted = 10;

/// A light of 1 x 1 m over a glossy floor, in parts x parts pieces side by side; the camera sees one point.
scenes::Scene glossy_floor(int parts) {
    std::string lights;
    for (int i = 0; i < parts * parts; ++i)
        lights += fmt::format(
            R"({}{{"corner": [{}, {}, {}], "edge_u": [0, {}, 0], "edge_v": [{}, 0, 0], "radiance": [{}, {}, {}]}})",
            i > 0 ? ", " : "", -0.5 + double(i / parts) / parts, -0.5 + double(i % parts) / parts, height,
            1.0 / parts, 1.0 / parts, emitted, emitted, emitted);
    return scenes::parse_scene(
        fmt::format(
            R"({{"name": "gloss", "camera": {{"position": [{}, {}, {}], "target": [0, 0, 0], "up": [0, 0, 1],
                                             "vertical_fov_degrees": 0.001}},
                "materials": {{"lacquer": {{"kind": "glossy", "diffuse": [0.3, 0.3, 0.3],
                                            "specular": [0.5, 0.5, 0.5], "exponent": 20}}}},
                "shapes": [{{"type": "quad", "material": "lacquer", "corner": [-5, -5, 0], "edge_u": [10, 0, 0],
                             "edge_v": [0, 10, 0]}}],
                "lights": [{}]}})",
            eye.x, eye.y, eye.z, lights),
        "gloss.json", ".");
}

/// The light's area in 400 x 400 pieces.
double by_quadrature(const Material& material) {
    constexpr int steps = 400;
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double x = (i + 0.5) / steps - 0.5, y = (j + 0.5) / steps - 0.5;
            const double distance2 = x * x + y * y + height * height, cosine = height / std::sqrt(distance2);
            const Vec3 direction = trace::normalize(
                Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(height)});
            const Vec3 f = brdf(material, {0, 0, 1}, direction, trace::normalize(eye));
            sum += static_cast<double>(f.x) * emitted * cosine * cosine / distance2;
        }
    return sum / (double{steps} * steps);
}

TEST(DirectLight, IsTheIntegralOverTheLightsWhateverTheRaysThatLookForIt) {
    for (const int parts : {1, 3}) {  // each light by itself; and one of nine at a time
        const scenes::Scene scene = glossy_floor(parts);
        const auto floor = std::find_if(scene.materials.begin(), scene.materials.end(),
                                        [](const Material& m) { return m.name == "lacquer"; });
        ASSERT_NE(floor, scene.materials.end());
        const double expected = by_quadrature(*floor);
        for (const auto& [shadow, gather] : {std::pair{1u, 1u}, {16u, 1u}, {32u, 2u}, {1u, 16u}}) {
            CaptureConfig config;
            config.pixels = {.width = 64,
                             .height = 64,
                             .gather_rays = gather,
                             .shadow_rays = shadow,
                             .max_specular = 2,
                             .seed = 3};
            config.photon.photons = 0;
            config.caustic.photons = 0;
            MomentsOf<1> pixels;
            std::uint64_t count = 0;
            for (const Vec3 pixel : capture(scene, config).image.pixels)
                pixels.add({static_cast<double>(pixel.x)}, ++count);
            const double error = std::sqrt(pixels.variance(0, count));
            EXPECT_LT(4 * error, 0.06 * expected) << parts << " " << shadow << " " << gather;
            EXPECT_NEAR(pixels.mean[0], expected, 4 * error) << parts << " " << shadow << " " << gather;
        }
    }
}

}  // namespace
}  // namespace regather::capture
