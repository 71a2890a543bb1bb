#include "meshes/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/meshes/parsed.h"
#include "tests/scratch.h"
#include "trace/file.h"

namespace regather::meshes {
namespace {

using ::testing::HasSubstr;

const std::string triangle_obj = "v 0 0 0\nv 2 0 0\nv 0 3 0\n", face = "f 1 2 3\n";

class MeshFile : public ::testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        trace::write_whole(folder_ / name, bytes);
        return folder_ / name;
    }
    static std::string refused(const std::filesystem::path& file) {
        try {
            read_mesh(file);
        } catch (const trace::DataError& error) {
            EXPECT_THAT(error.what(), ::testing::StartsWith(file.string() + ": "));
            return error.what();
        }
        return "";
    }
    Scratch folder_;
};

TEST_F(MeshFile, TheExtensionSaysTheFormatInLettersOfAnyCase) {
    EXPECT_EQ(format_of("a/b.obj"), Format::obj);
    EXPECT_EQ(format_of("b.PLY"), Format::ply);
    EXPECT_EQ(format_of("b.x.gLb"), Format::gltf);
    EXPECT_EQ(format_of("b.gltf"), Format::gltf);
    EXPECT_EQ(format_of("b.stl"), std::nullopt);
    EXPECT_EQ(format_of("obj"), std::nullopt);
}

TEST_F(MeshFile, LibrariesAndBuffersLieBesideIt) {
    write("sub/m.mtl", "newmtl red\nKd 0.75 0 0\n");
    const Mesh mesh = read_mesh(write("m.OBJ", "mtllib sub/m.mtl\nusemtl red\n" + triangle_obj + face));
    EXPECT_DOUBLE_EQ(area(mesh), 3);
    EXPECT_EQ(std::get<MtlTerms>(mesh.materials[mesh.triangle_material[0]].terms).kd, (Vec3{0.75f, 0, 0}));
    std::string bytes;
    for (const float x : {0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f, 3.f, 0.f}) put(bytes, x);
    write("m.bin", bytes);
    EXPECT_DOUBLE_EQ(
        area(read_mesh(write("sub/m.gltf", R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "buffers": [{"uri": "../m.bin", "byteLength": 36}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}]})"))),
        3);
}

TEST_F(MeshFile, ALibraryIsNamedByItsPathWhenItIsDamaged) {
    write("m.mtl", "newmtl red\nKd 1 0\n");
    try {
        read_mesh(write("m.obj", "mtllib m.mtl\n" + triangle_obj + face));
        FAIL();
    } catch (const trace::DataError& error) {
        EXPECT_EQ(error.what(), (folder_ / "m.mtl").string() +
                                    ": line 2: found a term without its number, expected a finite number");
    }
}

TEST_F(MeshFile, WhatIsNoRegularFileIsNotOpened) {
    for (const std::string name : {"/dev/zero", "sub", "."}) {
        std::filesystem::create_directories(folder_ / "sub");
        const Mesh mesh = read_mesh(write("m.obj", "mtllib " + name + "\n" + triangle_obj + face));
        EXPECT_EQ(mesh.missing_libraries, std::vector<std::string>{name});
    }
    std::filesystem::create_directories(folder_ / "folder.ply");
    EXPECT_THAT(refused(folder_ / "folder.ply"),
                HasSubstr("found no file, expected an OBJ, PLY or glTF mesh"));
}

TEST_F(MeshFile, AVeryLongNameIsCut) {
    for (const char* ending : {".obj", ".stl"}) {
        std::string message;
        try {
            read_mesh("\x1b" + std::string(5000, 'x') + ending);
        } catch (const trace::DataError& error) {
            message = error.what();
        }
        EXPECT_THAT(message, ::testing::StartsWith("\\x1bxxx"));
        EXPECT_LT(message.size(), 500u);
    }
}

TEST_F(MeshFile, MissingForeignAndEmptyFilesAreRefused) {
    EXPECT_THAT(refused(folder_ / "none.obj"), HasSubstr("found no file, expected an OBJ, PLY or glTF mesh"));
    EXPECT_THAT(refused(write("a.stl", "solid")),
                HasSubstr("found the extension \".stl\", expected .obj, .ply, .gltf or .glb"));
    for (const std::string name : {"e.obj", "e.ply", "e.gltf", "e.glb"}) {
        EXPECT_NE(refused(write(name, "")), "") << name;
        EXPECT_NE(refused(write(name, std::string(5000, '\xa7'))), "") << name;
    }
    EXPECT_NE(refused(write("p.obj", "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n")), "");
    EXPECT_NE(refused(write("o.ply", triangle_obj + face)), "");
    EXPECT_NE(refused(write("s.obj",
                            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                            "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n")),
              "");
    EXPECT_THAT(refused(write("z.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")),
                HasSubstr("no triangle with an area"));
}

TEST_F(MeshFile, FacesWithoutAreaAreDroppedCountedAndNamed) {
    const Mesh mesh =
        read_mesh(write("d.obj", triangle_obj + "v 4 0 0\ng a\n" + "f 1 2 4\ng b\n" + face + "f 1 1 2\n"));
    EXPECT_EQ(mesh.surface.triangles.size(), 1u);
    EXPECT_EQ(mesh.degenerate_faces, 2u);
    EXPECT_EQ(notes(mesh), "triangles without area are left out: 2\n");
    EXPECT_EQ(mesh.groups[mesh.triangle_group[0]], "b");
    EXPECT_EQ(mesh.surface.vertices.size(), 3u);
}

}  // namespace
}  // namespace regather::meshes
