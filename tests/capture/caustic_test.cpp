#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "capture/capture.h"
#include "scenes/loader.h"
#include "tests/capture/counts.h"
#include "tests/scratch.h"

namespace regather::capture {
namespace {

/// A light of 1 x 1 m at z = 1 that faces up to a mirror ceiling at z = 2, over a floor at z = 0; the camera
/// sees the floor at (3, 0, 0), which the light reaches by way of the mirror only.
scenes::Scene light_under_a_mirror() {
    return scenes::parse_scene(
        R"({"name": "mirrored", "camera": {"position": [3.3, 0, 0.4], "target": [3, 0, 0], "up": [0, 0, 1],
                                             "vertical_fov_degrees": 0.01},
            "materials": {"floor": {"kind": "diffuse", "diffuse": [0.8, 0.4, 0.2]},
                          "silver": {"kind": "mirror", "specular": [0.5, 0.5, 0.5]}},
            "shapes": [{"type": "quad", "material": "floor", "corner": [-6, -6, 0], "edge_u": [12, 0, 0], "edge_v": [0, 12, 0]},
                       {"type": "quad", "material": "silver", "corner": [-6, -6, 2], "edge_u": [0, 12, 0], "edge_v": [12, 0, 0]}],
            "lights": [{"corner": [-0.5, -0.5, 1], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0], "radiance": [10, 10, 10]}]})",
        "mirrored.json", ".");
}

/// Form factor from a point to a parallel rectangle at distance d whose corners are (x0, y0) and (x1, y1) off
/// the point's normal: Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3, for the four
/// rectangles between normal and corners.
double form_factor(double x0, double x1, double y0, double y1, double d) {
    const auto corner = [d](double x, double y) {
        const double a = x / d, b = y / d, s = std::sqrt(1 + a * a), t = std::sqrt(1 + b * b);
        return (a / s * std::atan(b / s) + b / t * std::atan(a / t)) / (2 * std::numbers::pi);
    };
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
}

CaptureConfig one_pixel(std::uint64_t seed) {
    CaptureConfig config;
    config.pixels = {
        .width = 1, .height = 1, .gather_rays = 0, .shadow_rays = 16, .max_specular = 8, .seed = seed};
    config.photon = {.photons = 1000, .seed = seed};
    config.caustic = {.photons = 400'000, .k = 100'000, .radius = 0.3f, .filter = Filter::none};
    return config;
}

TEST(CausticMap, APlaneMirrorLightsTheFloorLikeTheLightsMirrorImage) {
    // The image lies at z = 3 and has half the radiance. About 1000 photons a seed lie within the radius: 3 %
    // each, 1.1 % over 8; the interval below is 4 standard errors.
    const double truth = 0.8 * 5 * form_factor(-3.5, -2.5, -0.5, 0.5, 3);
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Captured captured = capture(light_under_a_mirror(), one_pixel(seed));
        EXPECT_EQ(captured.layers[Layer::direct].pixels[0], Vec3{});
        EXPECT_EQ(captured.layers[Layer::caustic].pixels[0], captured.image.pixels[0]);
        sum += static_cast<double>(captured.image.pixels[0].x);
    }
    EXPECT_NEAR(sum / 8 / truth, 1, 0.045);
}

TEST(CausticMap, WithoutItGatherRaysFindTheSameLight) {
    const double truth = 0.8 * 5 * form_factor(-3.5, -2.5, -0.5, 0.5, 3);
    CaptureConfig config = one_pixel(1);
    config.caustic.photons = 0;
    config.pixels.gather_rays = 200'000;  // of which about 1800 end on the light
    config.photon.photons = 0;
    const Captured captured = capture(light_under_a_mirror(), config);
    EXPECT_FALSE(captured.beside[Beside::caustic]);
    EXPECT_NEAR(static_cast<double>(captured.layers[Layer::caustic].pixels[0].x) / truth, 1, 0.09);
}

TEST(CausticMap, SeenDirectlyBothMapsHoldEachPhotonOnce) {
    // All light on the floor at (3, 0) is the mirror image's or comes back from the floor: the direct
    // visualisation of the global map leaves the first to the caustic map.
    CaptureConfig config = one_pixel(3);
    config.pixels.visualisation = Visualisation::direct;
    config.photon.photons = 200'000;
    config.gather = {.k = 100'000, .radius = 0.3f};
    const Captured both = capture(light_under_a_mirror(), config);
    config.caustic.photons = 0;
    const Captured global = capture(light_under_a_mirror(), config);
    EXPECT_EQ(global.layers[Layer::caustic].pixels[0], Vec3{});
    EXPECT_GT(both.layers[Layer::caustic].pixels[0].x, 0);
    EXPECT_NEAR(both.image.pixels[0].x / global.image.pixels[0].x, 1, 0.15);
}

TEST(CausticMap, IsATraceOfItsOwn) {
    const Scratch scratch;
    trace::TraceWriter global(scratch / "trace", false), caustic(scratch / "caustic", false);
    CaptureConfig config = one_pixel(1);
    config.pixels.width = config.pixels.height = 4;
    config.pixels.gather_rays = 4;
    config.caustic.photons = 2000;
    const Captured captured = capture(light_under_a_mirror(), config, {&global, {&caustic}});
    global.finish(captured.info);
    caustic.finish(*captured.beside[Beside::caustic]);
    trace::TraceReader reader(scratch / "caustic");
    EXPECT_EQ(reader.info().map, "caustic");
    EXPECT_EQ(reader.info().k, 100'000u);
    EXPECT_EQ(reader.info().photons, 2000u);
    EXPECT_EQ(reader.info().queries, 16u);  // one at each pixel's floor
    EXPECT_FALSE(reader.has("ray_eye_origin"));
    EXPECT_EQ(trace::TraceReader(scratch / "trace").info().map, "global");
    for (const std::uint32_t count : captured.layers.query_count) EXPECT_LE(count, 5u);
}

// --- what a scene does not need
// ---------------------------------------------------------------------------------

CaptureConfig small_room() {
    CaptureConfig config;
    config.pixels = {
        .width = 12, .height = 8, .gather_rays = 4, .shadow_rays = 4, .max_specular = 16, .seed = 5};
    config.photon = {.photons = 2000, .seed = 5};
    config.caustic.photons = 10;
    config.gather.k = 30;
    return config;
}

/// The scene `box` has a light and no specular surface.
struct Kept {
    Captured captured;
    trace::TraceInfo info;
    std::set<std::string> columns;
};
Kept captured_with(const scenes::Scene& scene, const std::set<std::string>& keep) {
    const Scratch scratch;
    CaptureConfig config = small_room();
    config.keep = keep;
    trace::TraceWriter writer(scratch / "trace", false), caustic(scratch / "caustic", false);
    Kept kept;
    kept.captured = capture(scene, config, {&writer, {&caustic}});
    writer.finish(kept.captured.info);
    const trace::TraceReader reader(scratch / "trace");
    kept.info = reader.info();
    for (const auto& [name, digest] : reader.digests()) kept.columns.insert(name);
    return kept;
}

bool is_left_out(const trace::TraceInfo& info, const std::string& what) {
    for (const trace::LeftOut& part : info.left_out)
        if (part.what == what && !part.why.empty()) return true;
    return false;
}

TEST(Needs, WithoutSpecularSurfacesThereIsNoCausticMapAndKeepingOneChangesNoPixel) {
    const scenes::Scene box = scenes::load_scene("box");
    const Kept without = captured_with(box, {}), with = captured_with(box, {"caustics"});
    EXPECT_FALSE(has_caustic_map(box, small_room()));
    EXPECT_FALSE(without.captured.beside[Beside::caustic]);
    EXPECT_TRUE(is_left_out(without.info, "caustic map"));
    ASSERT_TRUE(with.captured.beside[Beside::caustic]);
    EXPECT_EQ(with.captured.beside[Beside::caustic]->photons, 0u);
    EXPECT_GT(with.captured.beside[Beside::caustic]->queries, 0u);
    EXPECT_GT(count(with.captured.beside[Beside::caustic]->counts, "photon_paths"), 0u);
    EXPECT_EQ(with.captured.image.pixels, without.captured.image.pixels);
}

TEST(Needs, WithoutSpecularSurfacesThereIsNoSpecularRayAndNoColumnOfThem) {
    const scenes::Scene box = scenes::load_scene("box");
    const Kept without = captured_with(box, {}), with = captured_with(box, {"specular_rays"});
    EXPECT_EQ(count(without.info.counts, "specular_rays"), 0u);
    EXPECT_FALSE(without.columns.contains("ray_specular_origin"));
    EXPECT_TRUE(is_left_out(without.info, "ray_specular_origin"));
    EXPECT_TRUE(with.columns.contains("ray_specular_origin"));
    EXPECT_EQ(with.captured.image.pixels, without.captured.image.pixels);
}

TEST(Needs, WithoutLightsThereIsNoShadowRayNoPhotonPathAndNoColumnOfThem) {
    scenes::Scene dark = scenes::load_scene("box");
    dark.lights.clear();
    dark.triangle_light.assign(dark.triangle_light.size(), -1);
    const Kept without = captured_with(dark, {}), with = captured_with(dark, {"shadow_rays"});
    EXPECT_EQ(count(without.info.counts, "shadow_rays"), 0u);
    EXPECT_EQ(count(without.info.counts, "photon_paths"), 0u);
    EXPECT_FALSE(without.columns.contains("ray_shadow_origin"));
    EXPECT_TRUE(is_left_out(without.info, "ray_shadow_origin"));
    EXPECT_TRUE(with.columns.contains("ray_shadow_origin"));
    EXPECT_EQ(with.captured.image.pixels, without.captured.image.pixels);
}

}  // namespace
}  // namespace regather::capture
