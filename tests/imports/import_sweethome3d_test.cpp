#include "imports/homes/sweethome3d.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "imports/archived_model.h"
#include "tests/imports/home_text.h"
#include "tests/scenes/closed_surface.h"

namespace regather::imports {
namespace {

using scenes::is_closed;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST_F(Sweethome, APieceIsScaledTurnedAndPutInItsPlace) {
    // A quarter turn clockwise on the plan (y down): the front, which looked down the plan, looks left.
    const ImportedScene scene = import(HomeText{}.text());
    const trace::Bounds3 front = bounds_of(scene, "face"), body = bounds_of(scene, "amber");
    expect_near(body.min, {0.9f, -2.2f, 0.5f});
    expect_near(body.max, {1.1f, -1.8f, 0.6f});
    expect_near(front.min, {0.9f, -2.2f, 0.5f});
    expect_near(front.max, {0.9f, -1.8f, 0.6f});
}

TEST_F(Sweethome, FacesLookOutwardAlsoWhenMirrored) {
    for (const bool mirrored : {false, true}) {
        HomeText text;
        if (mirrored) text.piece.insert(18, "modelMirrored='true' ");
        const ImportedScene scene = import(text.text());
        for (const ImportedMesh& mesh : scene.meshes) {
            if (scene.materials[mesh.material].name != "face") continue;
            for (const auto& [a, b, c] : mesh.surface.triangles) {
                const Vec3 p = mesh.surface.vertices[a];
                EXPECT_LT(cross(mesh.surface.vertices[b] - p, mesh.surface.vertices[c] - p).x, 0);
            }
            for (const Vec3 n : mesh.surface.normals) expect_near(n, {-1, 0, 0});
        }
    }
}

TEST_F(Sweethome, MaterialsComeFromTheLibraryTheTableAndTheHome) {
    ImportedScene scene = import(HomeText{}.text());
    ASSERT_TRUE(find(scene, "face"));
    EXPECT_EQ(find(scene, "face")->diffuse, (Vec3{0.25f, 0.5f, 0.125f}));
    ASSERT_TRUE(find(scene, "amber"));
    EXPECT_EQ(find(scene, "amber")->kind, MaterialKind::glossy);
    EXPECT_NEAR(find(scene, "amber")->diffuse.x, 0.5755f, 1e-6);
    ASSERT_TRUE(find(scene, "pane"));
    EXPECT_EQ(find(scene, "pane")->kind, MaterialKind::dielectric);

    HomeText text;
    text.piece =
        R"(<pieceOfFurniture name='p' model='m/wedge.obj' x='1' y='2' width='40' depth='20' height='10' color='FFFF0000' shininess='0.5'><material name='face' color='FF000000' shininess='0'/></pieceOfFurniture>)";
    scene = import(text.text());
    EXPECT_EQ(find(scene, "face")->diffuse, Vec3{});
    EXPECT_EQ(find(scene, "face")->kind, MaterialKind::diffuse);
    EXPECT_EQ(find(scene, "amber")->kind, MaterialKind::glossy);
    EXPECT_EQ(find(scene, "amber")->exponent, 64);
    EXPECT_EQ(find(scene, "amber")->diffuse.y, 0);
    EXPECT_EQ(find(scene, "pane")->kind, MaterialKind::dielectric);
}

TEST_F(Sweethome, ALampIsASphereWhereItsSourceSays) {
    HomeText text;
    text.piece =
        R"(<light name='l' model='m/wedge.obj' x='100' y='200' elevation='50' width='40' depth='20' height='10' power='0.5'><lightSource x='0.75' y='0.5' z='0.5' color='FFFF0000' diameter='0.5'/></light>)";
    const ImportedScene scene = import(text.text());
    ASSERT_EQ(scene.lights.size(), 1u);
    expect_near(scene.lights[0].center, {1.1f, -2, 0.55f});
    EXPECT_NEAR(scene.lights[0].radius, 0.1, 1e-6);
    EXPECT_GT(scene.lights[0].power.x, 0);
    EXPECT_EQ(scene.lights[0].power.y, 0);
}

TEST_F(Sweethome, TheObserverLooksUpThePlanAtYawPi) {
    const ImportedScene scene = import(HomeText{}.text());
    expect_near(scene.camera.position, {1, -2, 1.7f});
    expect_near(scene.camera.target - scene.camera.position, {0, 1, 0});
    EXPECT_GE(scene.frames, 30u);
    EXPECT_EQ(scene.camera_path.size(), scene.frames);
    EXPECT_EQ(scene.camera_path.back().frame, scene.frames - 1);
}

TEST_F(Sweethome, FloorsFaceUpAndCeilingsDown) {
    const ImportedScene scene = import(HomeText{}.text());
    for (const ImportedMesh& mesh : scene.meshes) {
        const std::string& name = scene.materials[mesh.material].name;
        const bool up = name == "floor" || name == "ground";
        if (!up && name != "ceiling" && name != "plaster") continue;
        for (const auto& [a, b, c] : mesh.surface.triangles) {
            const Vec3 p = mesh.surface.vertices[a];
            const float z = cross(mesh.surface.vertices[b] - p, mesh.surface.vertices[c] - p).z;
            EXPECT_TRUE(up ? z > 0 : z < 0) << name;
        }
    }
}

TEST_F(Sweethome, PiecesOfAGroupAreTakenAndHiddenOnesAreNot) {
    const HomeText plain;
    HomeText grouped, hidden;
    grouped.piece = "<furnitureGroup name='g' x='0' y='0'>" + plain.piece + plain.piece + "</furnitureGroup>";
    hidden.piece = "<furnitureGroup name='g' visible='false'>" + plain.piece + "</furnitureGroup>";
    const auto faces = [&](const HomeText& text) {
        const ImportedScene scene = import(text.text());
        std::size_t count = 0;
        for (const ImportedMesh& mesh : scene.meshes)
            if (scene.materials[mesh.material].name == "face") count += mesh.surface.triangles.size();
        return count;
    };
    EXPECT_EQ(faces(plain), 2u);
    EXPECT_EQ(faces(grouped), 4u);
    EXPECT_EQ(faces(hidden), 0u);
}

TEST_F(Sweethome, WhatIsWrongInTheXmlIsNamed) {
    const auto with_wall = [&](const std::string& wall) {
        HomeText text;
        text.walls = wall;
        return refusal(text);
    };
    EXPECT_THAT(with_wall("<wall id='a' xStart='NaN' yStart='0' xEnd='1' yEnd='1' thickness='1'/>"),
                HasSubstr("t.sh3d: Home.xml: line 1: wall[0].xStart: found \"NaN\", expected a number"));
    EXPECT_THAT(with_wall("<wall id='a' yStart='0' xEnd='1' yEnd='1' thickness='1'/>"),
                HasSubstr("wall[0].xStart: found nothing"));
    EXPECT_THAT(with_wall("<wall id='a' xStart='1e300' yStart='0' xEnd='1' yEnd='1' thickness='1'/>"),
                HasSubstr("wall[0].xStart"));
    EXPECT_THAT(with_wall("<wall id='a' xStart='0' yStart='0' xEnd='1' yEnd='1' thickness='-1'/>"),
                HasSubstr("wall[0].thickness"));
    EXPECT_THAT(
        with_wall("<wall id='a' xStart='0' yStart='0' xEnd='1' yEnd='1' thickness='1' leftSideColor='red'/>"),
        HasSubstr("leftSideColor"));
    EXPECT_THAT(with_wall("<room><point x='0' y='0'/></room>"),
                HasSubstr("found 1 points, expected at least 3"));
    EXPECT_THAT(with_wall("<wall"),
                HasSubstr("line 1: found a start tag that does not end, expected a <home> in XML"));
    HomeText text;
    text.piece = "<pieceOfFurniture name='p' model='m/gone.obj' x='1' y='2' width='4' depth='2' height='1'/>";
    EXPECT_THAT(refusal(text), HasSubstr("t.sh3d: m/gone.obj: found no such entry"));
    text.piece =
        "<pieceOfFurniture name='p' model='m/wedge.obj' x='1' y='2' width='1e9' depth='2' height='1'/>";
    EXPECT_THAT(refusal(text), HasSubstr("width"));
    text.piece = "<pieceOfFurniture name='p' x='1' y='2' width='1' depth='2' height='1'/>";
    EXPECT_THAT(refusal(text), HasSubstr("pieceOfFurniture[0].model: found nothing"));
}

TEST_F(Sweethome, ABombOfEntitiesOrGroupsStaysSmall) {
    std::string bomb = "<?xml version='1.0'?><!DOCTYPE home [<!ENTITY a 'xxxxxxxxxx'>";
    for (char c = 'b'; c <= 'z'; ++c)
        bomb += fmt::format("<!ENTITY {} '&{};&{};&{};&{};'>", c, c - 1, c - 1, c - 1, c - 1);
    bomb += "]><home name='&z;'/>";
    EXPECT_THAT(data_error([&] { import(bomb); }), HasSubstr("neither a camera nor a room"));
    HomeText deep;
    deep.rest = std::string();
    for (int i = 0; i < 100'000; ++i) deep.rest += "<furnitureGroup>";
    for (int i = 0; i < 100'000; ++i) deep.rest += "</furnitureGroup>";
    EXPECT_THAT(refusal(deep), HasSubstr("expected at most 16"));
}

TEST_F(Sweethome, AModelThatIsDamagedOrLeavesItsFolderIsRefused) {
    const auto with_model = [&](const std::string& model) {
        write_zip(scratch_ / "t.sh3d", {{"Home.xml", HomeText{}.text()}, {"m/wedge.obj", model}});
        return data_error([&] { import_sweethome3d(scratch_ / "t.sh3d", ""); });
    };
    EXPECT_THAT(with_model("v 0 0 0\nf 1 2 3\n"),
                HasSubstr("t.sh3d: m/wedge.obj: line 2: found the vertex 3"));
    EXPECT_THAT(with_model("v nan 0 0\n"), HasSubstr("t.sh3d: m/wedge.obj: line 1: found \"nan\""));
    EXPECT_THAT(with_model(""), HasSubstr("t.sh3d: m/wedge.obj: found"));
    EXPECT_THAT(with_model("mtllib ../../../etc/passwd\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
                HasSubstr("expected one beside the model"));
}

TEST_F(Sweethome, AMissingOrDamagedTextureIsNamed) {
    for (const bool missing : {true, false}) {
        Entries entries{{"Home.xml", HomeText{}.text()},
                        {"m/wedge.obj", wedge},
                        {"m/wedge.mtl", "newmtl face\nKd 1 1 1\nmap_Kd t.png\n"}};
        if (!missing) entries.push_back({"m/t.png", "no image"});
        write_zip(scratch_ / "t.sh3d", entries);
        EXPECT_THAT(data_error([&] { import_sweethome3d(scratch_ / "t.sh3d", ""); }),
                    HasSubstr("t.sh3d: m/t.png: found"));
    }
}

TEST_F(Sweethome, AnArchiveWithoutAHomeSaysSo) {
    write_zip(scratch_ / "a.zip", {{"readme.xml", "<readme/>"}, {"Home", "serialised"}});
    EXPECT_THAT(data_error([&] { import_sweethome3d(scratch_ / "a.zip", ""); }),
                HasSubstr("a.zip: found neither Home.xml"));
}

TEST_F(Sweethome, AmongSeveralHomesTheNameChooses) {
    write_zip(scratch_ / "a.zip",
              {{"x/One.xml", HomeText{}.text()}, {"x/Two.xml", HomeText{}.text()}, {"m/wedge.obj", wedge}});
    EXPECT_EQ(import_sweethome3d(scratch_ / "a.zip", "Two").name, "Two");
    try {
        import_sweethome3d(scratch_ / "a.zip", "");
        ADD_FAILURE() << "no name, and two homes";
    } catch (const trace::UsageError& error) {
        EXPECT_THAT(error.what(), HasSubstr("found 2 homes and no --home, expected one of One, Two"));
    }
    EXPECT_THROW(import_sweethome3d(scratch_ / "a.zip", "Three"), trace::UsageError);
}

TEST(SweethomePackage, TheTwoBedroomApartmentIsAllThere) {
    const char* jar = "/usr/share/sweethome3d/sweethome3d.jar";
    REQUIRE_FILE_OF("sweethome3d", jar);
    const ImportedScene scene = import_sweethome3d(jar, "2BedroomApartment");
    EXPECT_EQ(scene.lights.size(), 12u);
    EXPECT_GT(scene.triangle_count(), 70'000u);
    EXPECT_LT(scene.triangle_count(), 100'000u);
    EXPECT_GE(scene.frames, 30u);
    EXPECT_THAT(scene.licence, HasSubstr("CC-BY"));
    bool glossy = false, glass = false;
    trace::Bounds3 bounds;
    for (const Material& material : scene.materials) {
        glossy |= material.kind == MaterialKind::glossy;
        glass |= material.kind == MaterialKind::dielectric;
    }
    for (const ImportedMesh& mesh : scene.meshes) bounds.include(trace::bounds_of(mesh.surface.vertices));
    EXPECT_TRUE(glossy && glass);
    EXPECT_NEAR(bounds.min.z, 0, 0.01);
    EXPECT_NEAR(bounds.max.z, 2.5, 0.01);
    EXPECT_NEAR(bounds.extent().x, 12, 0.5);
    for (const ImportedMesh& mesh : scene.meshes)
        EXPECT_TRUE(scene.materials[mesh.material].kind != MaterialKind::dielectric ||
                    is_closed(mesh.surface));
    for (const ImportedLight& light : scene.lights) EXPECT_GT(light.center.z, 0.5f);
}

}  // namespace
}  // namespace regather::imports
