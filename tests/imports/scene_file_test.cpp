#include "imports/scene_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>

#include "scenes/loader.h"
#include "tests/imports/archive.h"
#include "tests/scratch.h"

namespace regather::imports {

using scenes::Box;
using scenes::Scene;
using scenes::Sphere;
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

ImportedScene small_scene() {
    ImportedScene scene;
    scene.name = "small";
    scene.origin = "a test, \"quoted\"";
    scene.licence = "CC0";
    scene.camera = {{0, -3, 1}, {0, 0, 1}, {0, 0, 1}, 50};
    scene.camera_path = {{0, {0, -3, 1}, {0, 0, 1}, {0, 0, 1}}, {9, {1, -3, 1}, {0, 0, 1}, {0, 0, 1}}};
    scene.frames = 10;
    scene.materials = {
        {.name = "paint", .diffuse = {0.1f, 0.2f, 0.3f}},
        {.name = "lacquer",
         .kind = MaterialKind::glossy,
         .diffuse = {0.5f, 0, 0},
         .specular = {0.25f, 0.25f, 0.25f},
         .exponent = 20},
        {.name = "glass", .kind = MaterialKind::dielectric, .diffuse = {}, .index_of_refraction = 1.25f},
        {.name = "silver", .kind = MaterialKind::mirror, .diffuse = {}, .specular = {0.9f, 0.8f, 0.7f}}};
    for (std::uint32_t m = 0; m < 4; ++m) {
        const float x = 2 * static_cast<float>(m);
        scene.meshes.push_back({m, tessellate(Box{{x, 0, 0}, {x + 1, 1, 1}})});
    }
    scene.meshes.push_back({0, tessellate(Sphere{{0, 5, 0}, 1, 8})});
    ImportedLight rectangle;
    rectangle.corner = {0, 0, 3};
    rectangle.edge_u = {0, 2, 0};
    rectangle.edge_v = {3, 0, 0};
    rectangle.power = {60, 30, 10};
    ImportedLight sphere;
    sphere.shape = ImportedLight::Shape::sphere;
    sphere.center = {4, 4, 2};
    sphere.radius = 0.5f;
    sphere.radiance = {1, 2, 3};
    ImportedLight mesh;
    mesh.shape = ImportedLight::Shape::mesh;
    mesh.surface = tessellate(Box{{8, 8, 2}, {9, 9, 2.5f}});
    mesh.power = {5, 5, 5};
    scene.lights = {rectangle, sphere, mesh};
    return scene;
}

TEST(SceneFile, TheLoaderReadsWhatWasWritten) {
    const Scratch scratch;
    const ImportedScene written = small_scene();
    write_scene(written, scratch / "out");
    const Scene scene = scenes::load_scene((scratch / "out/scene.json").string());
    EXPECT_EQ(scene.name, "small");
    EXPECT_EQ(scene.origin, written.origin);
    EXPECT_EQ(scene.licence, "CC0");
    EXPECT_EQ(scene.frames, 10u);
    EXPECT_EQ(scene.camera_path.size(), 2u);
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_NEAR(scene.lights[0].power().x, 60, 1e-3);
    EXPECT_EQ(scene.lights[1].radiance, (Vec3{1, 2, 3}));
    EXPECT_NEAR(scene.lights[2].power().x, 5, 1e-3);
    std::size_t unlit = 0;
    for (const std::int32_t light : scene.triangle_light) unlit += light < 0;
    EXPECT_EQ(unlit, written.triangle_count());
    for (const Material& material : written.materials) {
        const auto same = std::find_if(scene.materials.begin(), scene.materials.end(),
                                       [&](const Material& m) { return m.name == material.name; });
        ASSERT_NE(same, scene.materials.end()) << material.name;
        EXPECT_EQ(same->kind, material.kind);
        EXPECT_EQ(same->diffuse, material.diffuse);
        EXPECT_EQ(same->specular, material.specular);
        EXPECT_EQ(same->index_of_refraction, material.index_of_refraction);
    }
}

TEST(SceneFile, AnyFirstByteOfTheFirstVertexIsReadBack) {
    for (const std::uint32_t low : {0x09u, 0x0au, 0x0du, 0x20u, 0x00u}) {
        const Scratch scratch;
        ImportedScene scene = small_scene();
        scene.meshes.resize(1);
        scene.lights.resize(1);
        for (Vec3& p : scene.meshes[0].surface.vertices)
            p.x = std::bit_cast<float>((std::bit_cast<std::uint32_t>(p.x + 1) & ~0xffu) | low);
        write_scene(scene, scratch / "out");
        const Scene read = scenes::load_scene((scratch / "out/scene.json").string());
        ASSERT_EQ(read.triangles.size(), 12u + 2) << low;
        EXPECT_EQ(read.vertices[read.triangles[0][0]],
                  scene.meshes[0].surface.vertices[scene.meshes[0].surface.triangles[0][0]]);
    }
}

TEST(SceneFile, TheSameSceneIsTheSameBytes) {
    const Scratch scratch;
    write_scene(small_scene(), scratch / "a");
    write_scene(small_scene(), scratch / "b");
    for (const auto& entry : fs::recursive_directory_iterator(scratch / "a"))
        if (entry.is_regular_file()) {
            const fs::path other = scratch / "b" / fs::relative(entry.path(), scratch / "a");
            EXPECT_EQ(trace::read_file(entry.path()), trace::read_file(other));
        }
}

TEST(SceneFile, AFolderThatHoldsSomethingIsNotReplacedUnlessForced) {
    const Scratch scratch;
    write_scene(small_scene(), scratch / "out");
    ImportedScene other = small_scene();
    other.name = "other";
    EXPECT_THROW(write_scene(other, scratch / "out"), trace::UsageError);
    EXPECT_EQ(scenes::load_scene((scratch / "out/scene.json").string()).name, "small");
    write_scene(other, scratch / "out/", true);
    EXPECT_EQ(scenes::load_scene((scratch / "out/scene.json").string()).name, "other");
}

TEST(SceneFile, EvenForceLeavesOtherPeoplesFoldersAlone) {
    const Scratch scratch;
    fs::create_directory(scratch / "out");
    trace::write_whole(scratch / "out/thesis.tex", "ten years");
    EXPECT_THROW(write_scene(small_scene(), scratch / "out", true), trace::UsageError);
    EXPECT_EQ(trace::read_file(scratch / "out/thesis.tex"), "ten years");
}

TEST(SceneFile, ASceneThatIsRefusedLeavesNothingBehind) {
    const Scratch scratch;
    const auto refusal = [&](const ImportedScene& scene) {
        return data_error([&] { write_scene(scene, scratch / "out"); });
    };
    ImportedScene scene = small_scene();
    scene.meshes.back().surface.vertices[3].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(refusal(scene), HasSubstr("a vertex that is not finite"));
    scene = small_scene();
    scene.materials[1].name = "paint";
    EXPECT_THAT(refusal(scene), HasSubstr("names that differ"));
    scene = small_scene();
    scene.lights[0].power = {};
    EXPECT_THAT(refusal(scene), HasSubstr("lights[0]: found neither power nor radiance"));
    scene = small_scene();
    scene.meshes[0].material = 4;
    EXPECT_THAT(refusal(scene), HasSubstr("expected one of 4"));
    scene = small_scene();
    scene.camera.position.x = INFINITY;
    EXPECT_THAT(refusal(scene), HasSubstr("camera.position"));
    EXPECT_TRUE(fs::is_empty(scratch.path()));
}

TEST(SceneFile, NamesArePlain) {
    EXPECT_EQ(plain_name("Bedroom #1"), "Bedroom__1");
    EXPECT_EQ(plain_name(""), "unnamed");
    EXPECT_EQ(plain_name(std::string(100, 'a')), std::string(64, 'a'));
}

}  // namespace
}  // namespace regather::imports
