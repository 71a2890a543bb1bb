#include <gtest/gtest.h>

#include "capture/query_pass.h"
#include "tests/capture/small_scenes.h"

namespace regather::capture {
namespace {

/// The camera at the origin looks along +x at a surface at x = 2; a light wall faces it from x = -3.
scenes::Scene looking_at(const std::string& material) {
    return scenes::parse_scene(
        R"({"name": "mirror", "camera": {"position": [0, 0, 0], "target": [1, 0, 0], "up": [0, 0, 1],
                                           "vertical_fov_degrees": 0.01},
            "materials": {"surface": )" + material + R"(},
            "shapes": [{"type": "quad", "material": "surface", "corner": [2, -1, -1], "edge_u": [0, 0, 2], "edge_v": [0, 2, 0]}],
            "lights": [{"corner": [-3, -1, -1], "edge_u": [0, 2, 0], "edge_v": [0, 0, 2], "radiance": [4, 4, 4]}]})",
        "mirror.json", ".");
}

Vec3 seen(const scenes::Scene& scene) {
    const RayCaster caster(scene);
    PixelWork work;
    QueryPass(scene, caster, {.width = 1, .height = 1, .gather_rays = 4, .shadow_rays = 4, .max_specular = 8, .seed = 1}, true)
        .run(0, 1, work);
    return work.radiance[0];
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

}  // namespace
}  // namespace regather::capture
