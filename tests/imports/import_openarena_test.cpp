#include "imports/maps/openarena.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zip.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <string>

#include "imports/archive.h"
#include "imports/maps/bsp.h"
#include "imports/maps/free_space.h"
#include "imports/maps/light_cluster.h"
#include "imports/maps/map_material.h"
#include "imports/texture_colour.h"
#include "scenes/camera_path.h"
#include "scenes/loader.h"
#include "tests/imports/bsp_text.h"
#include "trace/error.h"

namespace regather::imports {

using scenes::Scene;
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class OpenArena : public ::testing::Test {
protected:
    OpenArena() {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    ~OpenArena() override { fs::remove_all(folder_); }

    fs::path archive(const std::string& name,
                     const std::vector<std::pair<std::string, std::string>>& entries) const {
        const fs::path path = folder_ / name;
        zip_t* zip = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
        for (const auto& [entry, text] : entries)
            zip_file_add(zip, entry.c_str(), zip_source_buffer(zip, text.data(), text.size(), 0), 0);
        EXPECT_EQ(zip_close(zip), 0);
        return path;
    }
    static std::string map_text(const BspText& map) {
        const auto bytes = map.bytes();
        return {bytes.begin(), bytes.end()};
    }
    std::string refusal(const std::vector<fs::path>& files, const OpenArenaOptions& options) const {
        try {
            import_openarena(files, options);
        } catch (const std::exception& error) {
            return error.what();
        }
        return "taken";
    }

    const fs::path folder_ =
        fs::temp_directory_path() /
        ("openarena_test_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
};

// A TGA image of one colour, uncompressed, 2 x 1.
std::string tga(unsigned char r, unsigned char g, unsigned char b) {
    std::string bytes(18, '\0');
    bytes[2] = 2, bytes[12] = 2, bytes[14] = 1, bytes[16] = 24;
    for (int i = 0; i < 2; ++i)
        for (const unsigned char value : {b, g, r}) bytes += static_cast<char>(value);
    return bytes;
}

TEST_F(OpenArena, AHandMadeMapBecomesAScene) {
    const auto file = archive("a.pk3", {{"maps/Hand.bsp", map_text(hand_made_map())},
                                        {"textures/x/stone_floor.tga", tga(188, 0, 0)}});
    const ImportedScene map = import_openarena(std::vector{file}, {.map = "hand", .subdivision = 2});
    const ImportedScene& scene = map;
    EXPECT_EQ(scene.triangle_count(), 2u + 8u);  // The lamp is a light.
    ASSERT_EQ(scene.materials.size(), 3u);
    const auto& floor = *std::find_if(scene.materials.begin(), scene.materials.end(),
                                      [](const Material& m) { return m.name == "x_stone_floor"; });
    EXPECT_EQ(floor.kind, MaterialKind::diffuse);
    EXPECT_NEAR(floor.diffuse.x, 0.8, 1e-6);   // sRGB 188 is 0.503, twice that is more than the brightest.
    EXPECT_NEAR(floor.diffuse.y, 0.02, 1e-6);  // Nothing is quite black.
    ASSERT_EQ(scene.lights.size(), 1u);
    const ImportedLight& lamp = scene.lights[0];
    EXPECT_NEAR(trace::max_component(lamp.radiance), 2000 * 0.25 * 3 / (255.0 / 4), 1e-4);
    for (const auto& [a, b, c] : lamp.surface.triangles) {
        const auto& v = lamp.surface.vertices;
        EXPECT_LT(cross(v[b] - v[a], v[c] - v[a]).z, 0);  // It faces down, and 64 units are 2 m.
        EXPECT_NEAR(scenes::triangle_area(v[a], v[b], v[c]), 2, 1e-6);
        EXPECT_EQ(v[a].z, 4);
    }
    for (const ImportedMesh& mesh : scene.meshes)
        for (const auto& [a, b, c] : mesh.surface.triangles) {
            const auto& v = mesh.surface.vertices;
            EXPECT_GT(dot(cross(v[b] - v[a], v[c] - v[a]), Vec3{0.1f, 0, 1}), 0);
        }
    // Eyes are 50 units above the floor; the spawn point looks along y, where the way is free for 256 units.
    EXPECT_EQ(scene.camera.position, (Vec3{0, 0, 50.0f / 32}));
    EXPECT_NEAR(scene.camera.target.y, 4, 1e-5);
    EXPECT_GE(scene.frames, 30u);
    EXPECT_THAT(scene.origin, HasSubstr("hand \"By hand\" from a.pk3"));
    EXPECT_THAT(scene.licence, HasSubstr("GPL-2.0-or-later"));
}

TEST_F(OpenArena, TheSceneFileLoadsWithTheSameCounts) {
    const auto file = archive("a.pk3", {{"maps/hand.bsp", map_text(hand_made_map())}});
    const ImportedScene map = import_openarena(std::vector{file}, {.map = "hand"});
    write_scene(map, folder_ / "scene");
    const Scene scene = scenes::load_scene((folder_ / "scene" / "scene.json").string());
    EXPECT_EQ(scene.triangles.size(), map.triangle_count() + 2);
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.frames, map.frames);
    EXPECT_EQ(scene.licence, map.licence);
}

TEST_F(OpenArena, ScriptsDecideOverNamesAndLastArchivesOverFirst) {
    const auto first =
        archive("a.pk3", {{"maps/hand.bsp", map_text(hand_made_map())},
                          {"scripts/x.shader", "textures/x/lamp_2k { q3map_surfacelight 100 }"}});
    const auto second =
        archive("b.pk3", {{"scripts/X.shader", "textures/x/lamp_2k { q3map_surfacelight 51 }"}});
    const auto lamp = [&](const std::vector<fs::path>& files) {
        return trace::max_component(import_openarena(files, {.map = "hand"}).lights.at(0).radiance);
    };
    EXPECT_NEAR(lamp({first}), 100 * 3.0 / 255, 1e-5);
    EXPECT_NEAR(lamp({first, second}), 51 * 3.0 / 255, 1e-5);
}

TEST_F(OpenArena, FogTriggersFencesAndEffectsAreLeftOut) {
    BspText map = hand_made_map();
    map.texture("textures/x/fog", 0, 0x40).texture("textures/common/caulk").texture("textures/x/fence", 0, 0);
    map.texture("textures/x/flame1").texture("textures/x/plain", 0x80);
    for (std::int32_t texture = 3; texture < 8; ++texture) map.face(texture, 1, 0, 4, 0, 6);
    map.model(4, 5);
    const auto file = archive("a.pk3", {{"maps/hand.bsp", map_text(map)}});
    EXPECT_EQ(import_openarena(std::vector{file}, {.map = "hand", .subdivision = 1}).triangle_count(),
              2u + 2u);
}

TEST_F(OpenArena, MovingPartsStandAtTheirEntitysOrigin) {
    BspText map = hand_made_map();
    map.face(2, 1, 0, 4, 0, 6)
        .model(4, 1)
        .text("{\"classname\" \"func_door\" \"model\" \"*1\" \"origin\" \"0 0 320\"}");
    const auto file = archive("a.pk3", {{"maps/hand.bsp", map_text(map)}});
    const auto scene = import_openarena(std::vector{file}, {.map = "hand"});
    float highest = 0;
    for (const ImportedMesh& mesh : scene.meshes)
        for (const Vec3 p : mesh.surface.vertices) highest = std::max(highest, p.z);
    EXPECT_EQ(highest, 10);
}

// q3map lights a white surface 100 units below "light" 300 with 300 * 7500 / 100^2 = 225, which is 225 / (255
// / 4) of white.
TEST_F(OpenArena, ALightEntityLightsAsTheMapCompilerSays) {
    BspText map = hand_made_map();
    map.text("{\"classname\" \"light\" \"origin\" \"0 0 100\" \"light\" \"300\" \"_color\" \"1 0.5 0\"}");
    const auto file = archive("a.pk3", {{"maps/hand.bsp", map_text(map)}});
    const auto scene = import_openarena(std::vector{file}, {.map = "hand"});
    ASSERT_EQ(scene.lights.size(), 2u);
    const double distance = 100.0 / 32,
                 irradiance = double{scene.lights[1].power.x} / (4 * std::numbers::pi * distance * distance);
    EXPECT_NEAR(irradiance / std::numbers::pi, 225 / (255.0 / 4), 1e-4);
    EXPECT_NEAR(scene.lights[1].power.y / scene.lights[1].power.x, 0.5, 1e-6);
}

TEST_F(OpenArena, MapsThatAreNotThereAreAnsweredWithThoseThatAre) {
    const auto file = archive("a.pk3", {{"maps/hand.bsp", map_text(hand_made_map())}, {"maps/foot.bsp", ""}});
    EXPECT_EQ(refusal({file}, {.map = ""}), "map: none is named, expected one of foot, hand");
    EXPECT_EQ(refusal({file}, {.map = "hanf"}),
              "map: found \"hanf\", expected one of foot, hand; nearest: \"hand\"");
    EXPECT_THROW(import_openarena(std::vector{file}, {.map = "hanf"}), trace::UsageError);
    EXPECT_THAT(refusal({file}, {.map = "foot"}), HasSubstr("maps/foot.bsp: header: found 0 bytes"));
}

TEST_F(OpenArena, DamagedImagesAndScriptsAreRefusedByName) {
    const std::string map = map_text(hand_made_map());
    const auto image =
        archive("a.pk3", {{"maps/hand.bsp", map}, {"textures/x/metal.tga", tga(1, 2, 3).substr(0, 19)}});
    EXPECT_THAT(refusal({image}, {.map = "hand"}), HasSubstr("a.pk3: textures/x/metal.tga: found"));
    const auto script = archive("b.pk3", {{"maps/hand.bsp", map}, {"scripts/x.shader", "a {"}});
    EXPECT_THAT(refusal({script}, {.map = "hand"}),
                HasSubstr("b.pk3: scripts/x.shader: line 1: found the end"));
}

TEST_F(OpenArena, AMapOfTooManyTrianglesIsRefusedBeforeTheyAreMade) {
    BspText map = hand_made_map();
    for (int i = 0; i < 129 * 129; ++i) map.vertex({0, 0, 0}, {0, 0, 1});
    for (int i = 0; i < 20; ++i) map.face(0, 2, 17, 129 * 129, 0, 0, 129, 129);
    map.model(4, 20);
    const auto file = archive("a.pk3", {{"maps/hand.bsp", map_text(map)}});
    EXPECT_THAT(refusal({file}, {.map = "hand", .subdivision = 32}),
                HasSubstr("more than 4000000 triangles"));
}

TEST_F(OpenArena, AMapWithoutASpawnPointIsRefused) {
    BspText map = hand_made_map();
    std::string text = map_text(map);
    text.replace(text.find("info_player_deathmatch"), 22, "info_playex_deathmatch");
    EXPECT_THAT(refusal({archive("a.pk3", {{"maps/hand.bsp", text}})}, {.map = "hand"}),
                HasSubstr("no spawn point"));
}

TEST(MapMaterial, WordsAndScriptsDecideTheKind) {
    const auto kind = [](const char* name, const ShaderScript* script = nullptr, std::uint32_t contents = 1) {
        return map_material({name, 0, contents}, script, std::nullopt).kind;
    };
    ShaderScript shiny, blended;
    shiny.environment = true;
    blended.see_through = true;
    EXPECT_EQ(kind("textures/e7/e7bricks01"), MaterialKind::diffuse);
    EXPECT_EQ(kind("textures/e7/E7BrnMetal"), MaterialKind::glossy);
    EXPECT_EQ(kind("textures/x/plain", &shiny), MaterialKind::glossy);
    EXPECT_EQ(kind("textures/e7/e7swindow"), MaterialKind::mirror);
    EXPECT_EQ(kind("textures/x/glass01"), MaterialKind::glossy);  // Painted on a solid wall.
    EXPECT_EQ(kind("textures/x/glass01", &blended), MaterialKind::dielectric);
    EXPECT_EQ(kind("textures/liquids/clear", nullptr, BspTexture::water), MaterialKind::dielectric);
    for (const char* name : {"gold", "metal", "chrome", "rust"}) {
        const Material m = map_material({name, 0, 1}, nullptr, Vec3{1, 1, 1});
        EXPECT_LE(trace::max_component(m.kind == MaterialKind::mirror ? m.specular : m.diffuse + m.specular),
                  1)
            << name;
    }
}

// Two strips that share no corner, one of them of two triangles that share an edge.
TEST(LightCluster, PartsHangTogetherAndAreMergedByPlaceWhenThereAreTooMany) {
    Surface surface;
    for (int i = 0; i < 8; ++i) {
        const auto x = static_cast<float>(10 * i);
        const auto first = static_cast<std::uint32_t>(surface.vertices.size());
        for (const Vec3 p :
             {Vec3{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}})
            surface.vertices.push_back(p), surface.normals.push_back({0, 0, 1});
        surface.triangles.push_back({first, first + 1, first + 2});
        surface.triangles.push_back({first + 3, first + 4, first + 5});
    }
    const auto apart = cluster_lights(std::vector{surface}, 8).at(0);
    ASSERT_EQ(apart.size(), 8u);
    for (const Surface& part : apart) EXPECT_EQ(part.triangles.size(), 2u);
    const auto merged = cluster_lights(std::vector{surface, surface}, 8);
    EXPECT_LE(merged[0].size() + merged[1].size(), 8u);
    std::size_t triangles = 0;
    for (const auto& parts : merged)
        for (const Surface& part : parts) triangles += part.triangles.size();
    EXPECT_EQ(triangles, 32u);
    EXPECT_EQ(cluster_lights(std::vector{surface, surface}, 1).at(1).size(), 1u);
}

TEST(FreeSpace, BrushesAndTrianglesAreInTheWay) {
    const Bsp bsp = read_bsp(hand_made_map().bytes(), "m");
    const std::vector<std::array<Vec3, 3>> triangles{{Vec3{-300, 100, 0}, {300, 100, 0}, {0, 100, 600}}};
    const FreeSpace space(bsp, triangles);
    EXPECT_TRUE(space.clear({0, 0, 13}, 12));
    EXPECT_FALSE(space.clear({0, 0, 11}, 12));
    EXPECT_FALSE(space.clear({0, 0, -20}, 1));
    EXPECT_TRUE(space.clear({400, 0, -20}, 1));  // Beside the brush.
    EXPECT_TRUE(space.clear({0, 0, 50}, {0, 90, 50}, 5));
    EXPECT_FALSE(space.clear({0, 0, 50}, {0, 110, 50}, 5));
    EXPECT_FALSE(space.clear({0, 0, 50}, {0, 0, -50}, 5));
    EXPECT_EQ(space.floor_below({0, 0, 50}, 100), std::nullopt);
    EXPECT_EQ(space.first_met({0, 0, 50}, {0, 200, 50}), 0u);
}

struct RealMap {
    const char *archive, *package, *map;
    std::uint64_t fewest, most;
};

class RealMaps : public ::testing::TestWithParam<RealMap> {};

TEST_P(RealMaps, HasTheTrianglesLightsAndAPathThatNeverLeavesTheOpen) {
    const fs::path file = fs::path("/usr/share/games/openarena/baseoa") / GetParam().archive;
    if (!fs::exists(file)) GTEST_SKIP() << "skipped: package " << GetParam().package << " is not installed";
    const ImportedScene map = import_openarena(std::vector{file}, {.map = GetParam().map});
    EXPECT_GE(map.triangle_count(), GetParam().fewest);
    EXPECT_LE(map.triangle_count(), GetParam().most);
    EXPECT_GE(map.lights.size(), 1u);
    EXPECT_LE(map.lights.size(), 200u);
    ASSERT_GE(map.frames, 30u);
    Scene scene;
    scene.camera = map.camera;
    scene.camera_path = map.camera_path;
    scene.frames = map.frames;
    const std::string entry = std::string("maps/") + GetParam().map + ".bsp";
    const Bsp bsp = read_bsp(Zip::open(file).read(entry, 1 << 28), entry);
    const FreeSpace space(bsp, {});
    Vec3 before = scenes::camera_at(scene, 0).position;
    for (std::uint32_t frame = 0; frame < scene.frames; ++frame) {
        const Vec3 at = scenes::camera_at(scene, frame).position;
        EXPECT_TRUE(space.clear(at * 32, 2.9f)) << frame;
        EXPECT_LT(length(at - before), 1) << frame;
        before = at;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Debian, RealMaps,
    ::testing::Values(RealMap{"pak1-maps.pk3", "openarena-081-maps", "ctf_inyard", 40'000, 45'000},
                      RealMap{"pak1-maps.pk3", "openarena-081-maps", "oa_shouse", 34'000, 45'000},
                      RealMap{"z_oacmp-volume1-v3.pk3", "openarena-oacmp1", "oacmpdm9", 34'000, 45'000}),
    [](const auto& param) { return std::string(param.param.map); });

}  // namespace
}  // namespace regather::imports
