// No strategy changes the picture, only its noise: over seeds, the same photons and eye rays.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "capture/capture.h"
#include "scenes/loader.h"

namespace regather::capture {
namespace {

/// A room of 2 x 2 x 1 m, lit by a lamp behind a screen: the glossy floor and the walls get most light from
/// the wall behind it.
scenes::Scene room_with_a_screen() {
    return scenes::parse_scene(
        R"({"name": "screen", "camera": {"position": [1.8, 1, 0.8], "target": [0.9, 1, 0], "up": [0, 0, 1],
                                           "vertical_fov_degrees": 50},
            "materials": {"wall": {"kind": "diffuse", "diffuse": [0.7, 0.5, 0.3]},
                          "floor": {"kind": "glossy", "diffuse": [0.3, 0.3, 0.3], "specular": [0.4, 0.4, 0.4], "exponent": 30}},
            "shapes": [{"type": "quad", "material": "floor", "corner": [0, 0, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]},
                       {"type": "quad", "material": "wall", "corner": [0, 0, 1], "edge_u": [0, 2, 0], "edge_v": [2, 0, 0]},
                       {"type": "quad", "material": "wall", "corner": [0, 0, 0], "edge_u": [0, 0, 1], "edge_v": [2, 0, 0]},
                       {"type": "quad", "material": "wall", "corner": [0, 2, 0], "edge_u": [2, 0, 0], "edge_v": [0, 0, 1]},
                       {"type": "quad", "material": "wall", "corner": [0, 0, 0], "edge_u": [0, 2, 0], "edge_v": [0, 0, 1]},
                       {"type": "quad", "material": "wall", "corner": [2, 0, 0], "edge_u": [0, 0, 1], "edge_v": [0, 2, 0]},
                       {"type": "quad", "material": "wall", "corner": [0.4, 0.2, 0.1], "edge_u": [0, 1.6, 0], "edge_v": [0, 0, 0.9]}],
            "lights": [{"corner": [0.1, 0.8, 0.999], "edge_u": [0, 0.3, 0], "edge_v": [0.2, 0, 0], "power": [30, 30, 30]}]})",
        "screen.json", ".");
}

struct Pictures {
    double mean = 0, error = 0;  ///< Of the picture's mean light, and the deviation of that mean.
};

Pictures rendered(const std::string& sampling) {
    static const scenes::Scene scene = room_with_a_screen();
    constexpr int seeds = 12;
    CaptureConfig config;
    config.pixels.width = config.pixels.height = 6;
    config.pixels.gather_rays = 12;
    config.pixels.shadow_rays = 4;
    config.pixels.sampling = sampling;
    config.photon = {.photons = 5'000, .seed = 5};
    config.gather.k = 20;
    double mean = 0, mean2 = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        config.pixels.seed = static_cast<std::uint64_t>(100 + seed);
        const Captured result = capture(scene, config);
        double picture = 0;
        for (std::size_t p = 0; p < 36; ++p) {
            // A glossy surface sees lamps by gather rays, too, so what is direct belongs to it.
            const Vec3 all = result.image.pixels[p];
            const double light = static_cast<double>(all.x) + all.y + all.z;
            picture += light / 36;
        }
        mean += picture / seeds;
        mean2 += picture * picture / seeds;
    }
    return {mean, std::sqrt((mean2 - mean * mean) / (seeds - 1))};
}

TEST(Strategies, AllConvergeToTheSamePicture) {
    const Pictures by_cosine = rendered("cosine");
    ASSERT_LT(by_cosine.error, 0.02 * by_cosine.mean);
    for (const char* const spec :
         {"uniform", "brdf", "incident", "incident:rows=2,columns=4,k=20,shrink=0,floor=30", "combined",
          "combined:rows=8,columns=32", "mis", "mis:heuristic=power,brdf=30", "oracle:probes=1", "lobes",
          "lobes:lobes=9,k=40,shrink=0", "footprints:k=50"}) {
        const Pictures picture = rendered(spec);
        EXPECT_NEAR(picture.mean, by_cosine.mean, 4 * std::hypot(picture.error, by_cosine.error)) << spec;
        EXPECT_LT(picture.error, 0.03 * by_cosine.mean) << spec;
    }
}

}  // namespace
}  // namespace regather::capture
