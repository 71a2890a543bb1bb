#include "capture/light/light_probe.h"

#include <gtest/gtest.h>

#include <string>

#include "scenes/loader.h"
#include "spatial/photons/photon_kd.h"

namespace regather::capture {
namespace {

/// A surface at x = 2 that faces the origin, and a floor at z = -1 below.
scenes::Scene scene_of(const std::string& surface) {
    return scenes::parse_scene(
        R"({"name": "probe", "camera": {"position": [0, 0, 0], "target": [1, 0, 0], "up": [0, 0, 1],
                                          "vertical_fov_degrees": 60},
            "materials": {"surface": )" +
            surface + R"(, "floor": {"kind": "diffuse", "diffuse": [0.5, 0.25, 0]}},
            "shapes": [{"type": "quad", "material": "surface", "corner": [2, -1, -1], "edge_u": [0, 0, 2], "edge_v": [0, 2, 0]},
                       {"type": "quad", "material": "floor", "corner": [-9, -9, -1], "edge_u": [18, 0, 0], "edge_v": [0, 18, 0]}],
            "lights": [{"corner": [-1, -1, 8], "edge_u": [0, 2, 0], "edge_v": [2, 0, 0], "radiance": [4, 4, 4]}]})",
        "probe.json", ".");
}

/// Photons of 3 W, straight from above, on a square grid of 0.1 m on the floor: 300 W / m^2.
std::vector<trace::Photon> floor_photons() {
    std::vector<trace::Photon> photons;
    for (int i = 0; i < 160; ++i)
        for (int j = 0; j < 160; ++j) {
            trace::Photon photon;
            photon.position = {-8.0f + 0.1f * static_cast<float>(i), -8.0f + 0.1f * static_cast<float>(j),
                               -1};
            trace::encode_direction({0, 0, -1}, photon);
            trace::encode_normal({0, 0, 1}, photon);
            trace::encode_power({3, 3, 3}, photon.power);
            photons.push_back(photon);
        }
    return spatial::left_balanced(photons);
}

struct Probed {
    explicit Probed(const std::string& surface) : scene(scene_of(surface)), caster(scene) {}
    Vec3 seen(Vec3 direction) const {
        return LightProbe(scene, caster, photons, {.k = 200}).seen({0, 0, 0}, normalize(direction));
    }

    scenes::Scene scene;
    RayCaster caster;
    std::vector<trace::Photon> heap = floor_photons();
    spatial::PhotonKd photons{heap};
};

// 300 W / m^2 times albedo / pi; the grid's discs hold photons to within 5 %.
const Vec3 floor_light{300 * 0.5f / 3.14159265f, 300 * 0.25f / 3.14159265f, 0};

TEST(LightProbe, SeesWhatAFloorReflects) {
    const Probed probed(R"({"kind": "mirror", "specular": [0.5, 1, 1]})");
    const Vec3 seen = probed.seen({-0.3f, 0.2f, -1});
    EXPECT_NEAR(seen.x, floor_light.x, 0.05f * floor_light.x);
    EXPECT_NEAR(seen.y, floor_light.y, 0.05f * floor_light.y);
    EXPECT_EQ(seen.z, 0);
}

TEST(LightProbe, AMirrorShowsTheFloorTimesItsReflectance) {
    const Probed probed(R"({"kind": "mirror", "specular": [0.5, 1, 1]})");
    const Vec3 seen = probed.seen({1, 0, -0.4f});  // meets the mirror at z = -0.8, then the floor at x = 1.5
    EXPECT_NEAR(seen.x, 0.5f * floor_light.x, 0.03f * floor_light.x);
    EXPECT_NEAR(seen.y, floor_light.y, 0.05f * floor_light.y);
}

TEST(LightProbe, SeesNeitherLightsNorTheSky) {
    const Probed probed(R"({"kind": "mirror", "specular": [1, 1, 1]})");
    EXPECT_EQ(probed.seen({0, 0, 1}), Vec3{}) << "the light above";
    EXPECT_EQ(probed.seen({-1, 0, 0.5f}), Vec3{}) << "nothing";
}

// Straight on, a dielectric of index 1.5 lets 96 % through, over 2.25; light from behind it goes on to the
// floor.
TEST(LightProbe, GoesThroughADielectricByTheStrongerBranch) {
    const Probed probed(R"({"kind": "dielectric", "index_of_refraction": 1.5})");
    const Vec3 seen = probed.seen({1, 0, -0.3f});
    EXPECT_GT(seen.x, 0.9f / 2.25f * floor_light.x * 0.95f);
    EXPECT_LT(seen.x, 0.97f / 2.25f * floor_light.x * 1.05f);
}

}  // namespace
}  // namespace regather::capture
