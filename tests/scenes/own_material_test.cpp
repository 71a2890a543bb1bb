#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "scenes/mesh_material.h"
#include "tests/scenes/scene_text.h"

namespace regather::scenes {
namespace {

using ::testing::HasSubstr;

// Four triangles with a material each.
const std::string four_obj =
    "mtllib four.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "usemtl chalk\nf 1 2 3\nusemtl paint\nf 1 2 4\nusemtl pane\nf 1 3 4\nusemtl silver\nf 2 3 4\n";
const std::string four_mtl =
    "newmtl chalk\nKd 0.6 0.5 0.4\nKs 0 0 0\n"
    "newmtl paint\nKd 0.7 0.1 0.1\nKs 0.5 0.5 0.5\nNs 40\n"
    "newmtl pane\nKd 0.1 0.1 0.1\nd 0.2\nNi 1.4\nmap_Kd gone.png\n"
    "newmtl silver\nKd 0 0 0\nKs 0.9 0.8 0.7\nillum 3\n";

class OwnMaterials : public ::testing::Test {
protected:
    Scene scene(const std::string& keys = "") const {
        return parse_scene(text(keys), "t.json", folder_.path());
    }
    static std::string text(const std::string& keys) {
        return SceneText{.shapes = R"({"type": "mesh", "file": "four.obj")" + keys + "}"}.text();
    }
    static const Material& material(const Scene& scene, std::size_t triangle) {
        return scene.materials[scene.triangle_material[triangle]];
    }
    static const Material& named(const Scene& scene, const std::string& name) {
        for (std::size_t t = 0; t < scene.triangles.size(); ++t)
            if (material(scene, t).name == name) return material(scene, t);
        throw std::runtime_error("no triangle of " + name);
    }
    ScratchFolder folder_;
};

TEST_F(OwnMaterials, AreReadFromTheLibrary) {
    folder_.write("four.obj", four_obj);
    folder_.write("four.mtl", four_mtl);
    const Scene read = scene();
    EXPECT_EQ(named(read, "chalk").kind, MaterialKind::diffuse);
    EXPECT_EQ(named(read, "chalk").diffuse, (Vec3{0.6f, 0.5f, 0.4f}));
    const Material& paint = named(read, "paint");
    EXPECT_EQ(paint.kind, MaterialKind::glossy);
    EXPECT_EQ(paint.exponent, 40);
    EXPECT_FLOAT_EQ(paint.specular.x, 0.3f);  // 0.7 + 0.5 would be more than 1
    EXPECT_FLOAT_EQ(paint.specular.y, 0.5f);
    EXPECT_EQ(named(read, "pane").kind, MaterialKind::dielectric);
    EXPECT_FLOAT_EQ(named(read, "pane").index_of_refraction, 1.4f);
    EXPECT_EQ(named(read, "silver").kind, MaterialKind::mirror);
    EXPECT_EQ(named(read, "silver").specular, (Vec3{0.9f, 0.8f, 0.7f}));
}

TEST_F(OwnMaterials, GiveWayToTheScenes) {
    folder_.write("four.obj", four_obj);
    folder_.write("four.mtl", four_mtl);
    const Scene all = scene(R"(, "material": "white")");
    for (std::size_t t = 0; t < 4; ++t) EXPECT_EQ(material(all, t).name, "white");
    const Scene one = scene(R"(, "materials": {"pane": "white"})");
    EXPECT_EQ(named(one, "white").kind, MaterialKind::diffuse);
    EXPECT_EQ(named(one, "paint").kind, MaterialKind::glossy);
    EXPECT_THROW(named(one, "pane"), std::runtime_error);
    EXPECT_EQ(
        refusal(text(R"(, "materials": {"pan": "white"})"), folder_.path()),
        "t.json: shapes[0].materials.pan: found \"pan\", no material of \"four.obj\", expected \"pane\"");
    EXPECT_THAT(refusal(text(R"(, "materials": {"pane": "wite"})"), folder_.path()),
                HasSubstr("unknown material \"wite\""));
}

TEST_F(OwnMaterials, ACopyOfTheMeshSharesThem) {
    folder_.write("four.obj", four_obj);
    folder_.write("four.mtl", four_mtl);
    const std::string shape = R"({"type": "mesh", "file": "four.obj"})";
    const Scene twice =
        parse_scene(SceneText{.shapes = shape + "," + shape}.text(), "t.json", folder_.path());
    EXPECT_EQ(twice.triangles.size(), 8u);
    EXPECT_EQ(twice.materials.size(), 5u);  // white, and the four
}

TEST_F(OwnMaterials, AMissingLibraryIsRefusedUnlessEveryFaceHasAMaterialOfTheScene) {
    folder_.write("four.obj", four_obj);
    EXPECT_EQ(refusal(text(""), folder_.path()),
              "t.json: shapes[0].file: found no material library \"four.mtl\", expected that file, or a "
              "\"material\" for all faces");
    EXPECT_EQ(refusal(text(R"(, "material": "white")"), folder_.path()), "");
    EXPECT_EQ(
        refusal(
            text(
                R"(, "materials": {"chalk": "white", "paint": "white", "pane": "white", "silver": "white"})"),
            folder_.path()),
        "");
}

TEST_F(OwnMaterials, FacesWithoutOneAreGrey) {
    folder_.write("four.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Scene grey = scene();
    EXPECT_EQ(material(grey, 0).name, "default");
    EXPECT_EQ(material(grey, 0).diffuse, (Vec3{0.5f, 0.5f, 0.5f}));
}

TEST_F(OwnMaterials, OfSeveralLibrariesOneThatIsThereDescribesItsOwn) {
    folder_.write("four.obj", "mtllib gone.mtl four.mtl\n" + four_obj.substr(four_obj.find('\n') + 1));
    folder_.write("four.mtl", four_mtl);
    EXPECT_EQ(named(scene(), "chalk").diffuse, (Vec3{0.6f, 0.5f, 0.4f}));
    folder_.write("four.mtl", four_mtl.substr(0, four_mtl.find("newmtl silver")));
    EXPECT_THAT(refusal(text(""), folder_.path()), HasSubstr("no material library \"gone.mtl\""));
}

TEST_F(OwnMaterials, DamagedLibrariesAndObjectsAreRefusedWithTheirLine) {
    folder_.write("four.obj", four_obj);
    folder_.write("four.mtl", "newmtl a\nKd 1 1\n");
    EXPECT_THAT(refusal(text(""), folder_.path()),
                HasSubstr("four.mtl: line 2: found a term without its number, expected a finite number)"));
    folder_.write("four.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n");
    EXPECT_THAT(refusal(text(""), folder_.path()), HasSubstr("four.obj: line 4: found the vertex 0"));
}

TEST_F(OwnMaterials, ALibraryThatIsNoPlainFileIsNotOpened) {
    folder_.write("four.obj", "mtllib /dev/zero\n" + four_obj.substr(four_obj.find('\n') + 1));
    EXPECT_THAT(refusal(text(""), folder_.path()), HasSubstr("no material library \"/dev/zero\""));
}

TEST_F(OwnMaterials, AnyChangedByteOfALibraryIsRefusedOrReadWithoutHarm) {
    folder_.write("four.obj", four_obj);
    for (std::size_t at = 0; at < four_mtl.size(); ++at)
        for (const char c : {'\0', '9', '\n', '\xff'}) {
            std::string damaged = four_mtl;
            damaged[at] = c;
            folder_.write("four.mtl", damaged);
            EXPECT_EQ(refusal(text(""), folder_.path()).find('\n'), std::string::npos);
        }
}

TEST(MeshMaterial, TheRulesOfMtl) {
    EXPECT_EQ(material_of("a", MtlTerms{.d = 0.49f}).kind, MaterialKind::dielectric);
    EXPECT_EQ(material_of("a", MtlTerms{.d = 0.5f}).kind, MaterialKind::diffuse);
    for (const int illum : {4, 6, 7, 9})
        EXPECT_EQ(material_of("a", MtlTerms{.illum = illum}).kind, MaterialKind::dielectric);
    EXPECT_EQ(material_of("a", MtlTerms{.ni = 1, .illum = 4}).index_of_refraction, 1.5f);
    EXPECT_EQ(material_of("a", MtlTerms{.ni = 99, .illum = 4}).index_of_refraction, 10);
    // A bright body under a reflecting illum is paint, not a mirror.
    EXPECT_EQ(
        material_of("a", MtlTerms{.kd = {0.5f, 0, 0}, .ks = {0.2f, 0.2f, 0.2f}, .ns = 9, .illum = 3}).kind,
        MaterialKind::glossy);
    EXPECT_EQ(material_of("a", MtlTerms{.ks = {0.2f, 0.2f, 0.2f}, .ns = 0}).kind, MaterialKind::diffuse);
    EXPECT_EQ(material_of("a", MtlTerms{.kd = {2, -1, 0.5f}}).diffuse, (Vec3{1, 0, 0.5f}));
}

TEST(MeshMaterial, TheRulesOfMetallicRoughness) {
    const Vec3 gold{1, 0.8f, 0.3f};
    EXPECT_EQ(material_of("a", MetallicRoughness{.base_color = gold, .roughness = 0.05f}).kind,
              MaterialKind::mirror);
    const Material brushed = material_of("a", MetallicRoughness{.base_color = gold, .roughness = 0.5f});
    EXPECT_EQ(brushed.kind, MaterialKind::glossy);
    EXPECT_EQ(brushed.specular, gold);
    EXPECT_FLOAT_EQ(brushed.exponent, 2 / 0.0625f - 2);
    EXPECT_EQ(material_of("a", MetallicRoughness{.metallic = 0, .roughness = 1}).kind, MaterialKind::diffuse);
    EXPECT_EQ(material_of("a", MetallicRoughness{.metallic = 0, .transmission = 1}).kind,
              MaterialKind::dielectric);
}

const std::string sphere_light = R"({"type": "sphere", "center": [0, 0, 3], "radius": 0.5, "segments": )";

TEST(MeshLight, ASphereLightsAreaGoesToFourPiRSquared) {
    const double exact = std::numbers::pi;  // 4 pi 0.5^2
    double before = 0;
    for (const int segments : {16, 32, 64, 128}) {
        const Scene scene =
            parse(SceneText{.lights = sphere_light + std::to_string(segments) + R"(, "radiance": [2, 2, 2]})"}
                      .text());
        ASSERT_EQ(scene.lights.size(), 1u);
        const AreaLight& light = scene.lights[0];
        EXPECT_TRUE(light.is_mesh());
        const double lost = exact - static_cast<double>(light.area());
        EXPECT_GT(lost, 0);
        if (before > 0) {
            EXPECT_NEAR(before / lost, 4, 0.2) << segments;
        }
        before = lost;
        EXPECT_EQ(light.first_triangle, 2u);
        EXPECT_EQ(light.first_triangle + light.triangle_count, scene.triangles.size());
        for (std::size_t t = 0; t < scene.triangles.size(); ++t)
            EXPECT_EQ(scene.triangle_light[t], t < 2 ? -1 : 0);
    }
    EXPECT_LT(before / exact, 1e-3);
}

TEST(MeshLight, PowerIsPiTimesItsMeshsAreaTimesRadiance) {
    const Scene scene = parse(SceneText{.lights = sphere_light + R"(64, "power": [60, 30, 10]}, )" +
                                                  sphere_light + R"(8, "power": [1, 1, 1]})"}
                                  .text());
    EXPECT_NEAR(scene.lights[0].power().x, 60, 1e-3);
    EXPECT_NEAR(scene.lights[0].radiance.x, 60 / (std::numbers::pi * scene.lights[0].area()), 1e-4);
    EXPECT_EQ(scene.lights[1].first_triangle,
              scene.lights[0].first_triangle + scene.lights[0].triangle_count);
    EXPECT_EQ(scene.triangle_light.back(), 1);
}

TEST(MeshLight, AFilesTrianglesShine) {
    const ScratchFolder folder;
    folder.write("l.obj", "v 0 0 0\nv 3 0 0\nv 0 4 0\nv 0 0 1\nf 1 2 3\nf 1 2 2\n");
    const std::string light =
        R"({"type": "mesh", "file": "l.obj", "scale": 2, "translate": [0, 0, 5], "radiance": [1, 1, 1]})";
    const Scene scene = parse_scene(SceneText{.lights = light}.text(), "t.json", folder.path());
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].triangle_count, 1u);
    EXPECT_FLOAT_EQ(scene.lights[0].area(), 24);  // 3 x 4 / 2, times 2^2
    EXPECT_EQ(scene.materials[scene.triangle_material.back()].diffuse, Vec3{});
}

}  // namespace
}  // namespace regather::scenes
