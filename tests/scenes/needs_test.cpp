#include "scenes/needs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"
#include "trace/error.h"

namespace regather::scenes {
namespace {

using ::testing::HasSubstr;

const std::string lamp =
    R"({"corner": [0, 0, 3], "edge_u": [0, 1, 0], "edge_v": [1, 0, 0], "power": [1, 1, 1]})";

std::string sphere(const std::string& material) {
    return R"({"type": "sphere", "material": ")" + material +
           R"(", "center": [0, 0, 0], "radius": 1, "segments": 4})";
}

const std::string all_materials = R"("white": {"kind": "diffuse", "diffuse": [0.5, 0.5, 0.5]},
    "lacquer": {"kind": "glossy", "diffuse": [0.5, 0.5, 0.5], "specular": [0.1, 0.1, 0.1], "exponent": 20},
    "dull": {"kind": "glossy", "diffuse": [0.5, 0.5, 0.5], "specular": [0, 0, 0], "exponent": 20},
    "silver": {"kind": "mirror", "specular": [0.9, 0.9, 0.9]},
    "glass": {"kind": "dielectric", "index_of_refraction": 1.5})";

TEST(Needs, ADiffuseSceneWithoutLightsNeedsNothing) {
    const Needs needs = needs_of(parse(SceneText{.materials = all_materials}.text()));
    for (const Need* need : needs.list()) EXPECT_FALSE(need->needed) << need->part;
    EXPECT_EQ(needs.shadow_rays.reason, "The scene has no light of area.");
    EXPECT_EQ(needs.specular_rays.reason, "No triangle is a mirror or a dielectric.");
    EXPECT_EQ(needs.caustics.reason, "No triangle is a mirror or a dielectric: no path makes a caustic.");
    EXPECT_EQ(needs.camera_path.reason, "The camera stands still.");
    EXPECT_EQ(needs.glossy_lobes.reason, "No triangle is glossy.");
}

TEST(Needs, ALightOfAreaNeedsShadowRaysOnly) {
    const Needs needs = needs_of(parse(SceneText{.lights = lamp}.text()));
    EXPECT_TRUE(needs.shadow_rays.needed);
    EXPECT_FALSE(needs.specular_rays.needed);
    EXPECT_FALSE(needs.glossy_lobes.needed);
    EXPECT_EQ(needs.shadow_rays.reason, "1 light of area lights the scene.");
}

TEST(Needs, MirrorsAndDielectricsNeedSpecularRays) {
    for (const std::string material : {"silver", "glass"}) {
        const Needs needs =
            needs_of(parse(SceneText{.materials = all_materials, .shapes = sphere(material)}.text()));
        EXPECT_TRUE(needs.specular_rays.needed) << material;
        EXPECT_FALSE(needs.glossy_lobes.needed) << material;
        EXPECT_EQ(needs.specular_rays.reason,
                  "8 triangles are of mirror or dielectric materials (" + material + ").");
    }
}

TEST(Needs, ACausticNeedsALightAndASpecularSurface) {
    const auto caustics = [](const std::string& lights, const std::string& material) {
        return needs_of(
                   parse(SceneText{.materials = all_materials, .shapes = sphere(material), .lights = lights}
                             .text()))
            .caustics;
    };
    EXPECT_TRUE(caustics(lamp, "glass").needed);
    EXPECT_TRUE(caustics(lamp, "silver").needed);
    EXPECT_FALSE(caustics(lamp, "lacquer").needed);
    EXPECT_FALSE(caustics("", "glass").needed);
    EXPECT_EQ(caustics("", "glass").reason, "The scene has no light of area whose light could be gathered.");
}

TEST(Needs, APartCanBeKeptThoughItIsNotNeeded) {
    Needs needs = needs_of(parse(SceneText{.materials = all_materials}.text()));
    needs.keep({"caustics"});
    EXPECT_TRUE(needs.caustics.needed);
    EXPECT_FALSE(needs.shadow_rays.needed);
    EXPECT_THAT(needs.caustics.reason, HasSubstr("Kept although it is not needed"));
    for (const char* part : {"caustic", "", "camera_path", "glossy_lobes"})
        EXPECT_THROW(needs.keep({part}), trace::UsageError) << part;
}

TEST(Needs, GlossNeedsLobesUnlessItsSpecularPartIsZero) {
    EXPECT_TRUE(needs_of(parse(SceneText{.materials = all_materials, .shapes = sphere("lacquer")}.text()))
                    .glossy_lobes.needed);
    EXPECT_FALSE(needs_of(parse(SceneText{.materials = all_materials, .shapes = sphere("dull")}.text()))
                     .glossy_lobes.needed);
}

TEST(Needs, EveryReasonIsASentence) {
    const Needs needs = needs_of(load_scene("house"));
    for (const Need* need : needs.list()) {
        EXPECT_TRUE(need->needed) << need->part;
        EXPECT_EQ(need->reason.back(), '.') << need->reason;
    }
}

}  // namespace
}  // namespace regather::scenes
