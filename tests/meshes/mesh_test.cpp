#include "meshes/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "tests/scenes/closed_surface.h"
#include "tests/scenes/scene_text.h"

namespace regather::scenes {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// A unit cube of six quads that face outward.
const std::string cube_obj =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

const std::string ply_header =
    "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 6\nproperty list uchar int vertex_indices\nend_header\n";

const std::string cube_ply = "ply\nformat ascii 1.0\n" + ply_header +
                             "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
                             "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

std::string binary_cube_ply() {
    std::string bytes = "ply\nformat binary_little_endian 1.0\n" + ply_header;
    const auto put = [&](auto value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        bytes.append(raw, sizeof value);
    };
    for (const Vec3 p :
         {Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}})
        for (int axis = 0; axis < 3; ++axis) put(p[axis]);
    for (const std::array<int, 4>& face :
         {std::array{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}) {
        put(static_cast<unsigned char>(4));
        for (const int i : face) put(i);
    }
    return bytes;
}

std::string mesh_refusal(const std::filesystem::path& file) {
    try {
        read_mesh(file);
    } catch (const trace::DataError& error) {
        EXPECT_THAT(error.what(), StartsWith(file.string() + ": found "));
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.what();
    }
    return "";
}

class MeshFile : public ::testing::Test {
protected:
    ScratchFolder folder_;
};

TEST_F(MeshFile, ACubeIsReadFromObjAndPlyAlike) {
    const std::filesystem::path files[] = {folder_.write("a.obj", cube_obj), folder_.write("a.ply", cube_ply),
                                           folder_.write("b.PLY", binary_cube_ply())};
    for (const auto& file : files) {
        const Mesh mesh = read_mesh(file);
        EXPECT_EQ(mesh.surface.triangles.size(), 12u) << file;
        EXPECT_EQ(mesh.degenerate_faces, 0u);
        EXPECT_EQ(unpaired_edges(mesh.surface.vertices, mesh.surface.triangles), 0u) << file;
        EXPECT_NEAR(volume(mesh.surface.vertices, mesh.surface.triangles), 1, 1e-6) << file;
        EXPECT_EQ(mesh.surface.normals.size(), mesh.surface.vertices.size());
        for (const Vec3 normal : mesh.surface.normals) EXPECT_EQ(normal, Vec3{});  // none in the file: flat
    }
}

TEST_F(MeshFile, NormalsOfTheFileAreKeptAtUnitLength) {
    const Mesh mesh =
        read_mesh(folder_.write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 2\nf 1//1 2//1 3//1\n"));
    ASSERT_EQ(mesh.surface.normals.size(), 3u);
    for (const Vec3 normal : mesh.surface.normals) EXPECT_EQ(normal, (Vec3{0, 0, 1}));
}

TEST_F(MeshFile, FacesWithoutAreaAreDroppedAndCounted) {
    const Mesh mesh =
        read_mesh(folder_.write("d.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\n"));
    EXPECT_EQ(mesh.surface.triangles.size(), 1u);
    EXPECT_EQ(mesh.degenerate_faces, 2u);
}

TEST_F(MeshFile, MissingForeignAndEmptyFilesAreRefused) {
    EXPECT_THAT(mesh_refusal(folder_.path() / "none.obj"),
                HasSubstr("found no file, expected an OBJ, PLY or glTF mesh"));
    EXPECT_THAT(mesh_refusal(folder_.write("a.stl", "solid")),
                HasSubstr("found the extension \".stl\", expected .obj, .ply, .gltf or .glb"));
    EXPECT_THAT(mesh_refusal(folder_.write("e.obj", "")), HasSubstr("found"));
    EXPECT_THAT(mesh_refusal(folder_.write("e.ply", "")), HasSubstr("found"));
    EXPECT_THAT(mesh_refusal(folder_.write("v.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), HasSubstr("found"));
    EXPECT_THAT(mesh_refusal(folder_.write("z.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")),
                HasSubstr("no triangle with an area"));
    EXPECT_NE(mesh_refusal(folder_.path()), "");
}

TEST_F(MeshFile, GarbageIsRefused) {
    EXPECT_NE(mesh_refusal(folder_.write("g.ply", std::string(5000, '\xa7'))), "");
    EXPECT_NE(mesh_refusal(folder_.write("g.obj", std::string(5000, '\xa7'))), "");
    EXPECT_NE(mesh_refusal(folder_.write("h.ply", cube_obj)), "");
    // Another format under a false name is not read by that format's importer.
    EXPECT_NE(
        mesh_refusal(folder_.write("s.obj",
                                   "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                   "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n")),
        "");
}

TEST_F(MeshFile, IndicesBeyondTheVerticesAreRefused) {
    EXPECT_NE(mesh_refusal(folder_.write("i.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n")), "");
    std::string ply = cube_ply;
    ply.replace(ply.rfind("4 3 0 4 7"), 9, "4 3 0 4 8");
    EXPECT_NE(mesh_refusal(folder_.write("i.ply", ply)), "");
    ply.replace(ply.rfind("4 3 0 4 8"), 9, "4 3 0 4 -1");
    EXPECT_NE(mesh_refusal(folder_.write("j.ply", ply)), "");
}

TEST_F(MeshFile, NumbersThatAreNotFiniteAreRefused) {
    for (const std::string bad : {"nan", "inf", "-inf", "1e99"}) {
        std::string ply = cube_ply;
        ply.replace(ply.find("1 1 1\n"), 1, bad);
        EXPECT_NE(mesh_refusal(folder_.write("x.ply", ply)), "") << bad;
        std::string obj = cube_obj;
        obj.replace(obj.find("v 1 1 1"), 3, "v " + bad);
        EXPECT_NE(mesh_refusal(folder_.write("x.obj", obj)), "") << bad;
    }
}

TEST_F(MeshFile, APlyCutAnywhereIsRefused) {
    // An ASCII file that only lacks its last line end is whole.
    for (std::size_t length = 0; length + 2 < cube_ply.size(); ++length)
        EXPECT_NE(mesh_refusal(folder_.write("cut.ply", cube_ply.substr(0, length))), "") << length;
    const std::string binary = binary_cube_ply();
    for (std::size_t length = 0; length < binary.size(); ++length)
        EXPECT_NE(mesh_refusal(folder_.write("cut.ply", binary.substr(0, length))), "") << length;
}

TEST_F(MeshFile, ABigEndianPlyIsReadAlike) {
    std::string bytes = "ply\nformat binary_big_endian 1.0\ncomment by hand\n" + ply_header;
    bytes.replace(bytes.find("vertex 8"), 8, "vertex 3");
    bytes.replace(bytes.find("face 6"), 6, "face 1");
    const std::string one = {'\x3f', '\x80', 0, 0}, zero(4, '\0');  // 1.0f is 0x3f800000
    bytes += zero + zero + zero + one + zero + zero + zero + one + zero;
    bytes += std::string{3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2};
    const Mesh mesh = read_mesh(folder_.write("big.ply", bytes));
    ASSERT_EQ(mesh.surface.triangles.size(), 1u);
    const auto [a, b, c] = mesh.surface.triangles[0];
    EXPECT_EQ(triangle_area(mesh.surface.vertices[a], mesh.surface.vertices[b], mesh.surface.vertices[c]),
              0.5);
    bytes.back() = 3;
    EXPECT_THAT(mesh_refusal(folder_.write("bad.ply", bytes)),
                HasSubstr("found face 1 of 1 with vertex 3 of 3"));
}

TEST_F(MeshFile, AnObjCutAnywhereIsRefusedOrReadsAsAPartOfTheCube) {
    for (std::size_t length = 0; length < cube_obj.size(); ++length) {
        try {
            const Mesh mesh = read_mesh(folder_.write("cut.obj", cube_obj.substr(0, length)));
            EXPECT_LE(mesh.surface.triangles.size(), 12u);
            for (const Vec3 p : mesh.surface.vertices)
                for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(p[axis] == 0 || p[axis] == 1);
        } catch (const trace::DataError&) {
        }
    }
}

TEST_F(MeshFile, ASceneScalesThenRotatesThenMovesIt) {
    folder_.write("t.obj", "v 1 0 0\nv 2 0 0\nv 1 1 1\nf 1 2 3\n");
    const std::string shape = R"({"type": "mesh", "material": "white", "file": "t.obj", "scale": 2,
        "rotate_z_degrees": 90, "translate": [10, 20, 30]})";
    const Scene scene = parse_scene(SceneText{.shapes = shape}.text(), "t.json", folder_.path());
    ASSERT_EQ(scene.triangles.size(), 1u);
    // (1, 1, 1) -> (2, 2, 2) -> (-2, 2, 2) -> (8, 22, 32)
    const Vec3 expected[] = {{10, 22, 30}, {10, 24, 30}, {8, 22, 32}};
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(length(scene.vertices[scene.triangles[0][i]] - expected[i]), 0, 1e-5) << i;
}

TEST_F(MeshFile, ASceneNamesItsFieldAndTheMeshFileInARefusal) {
    const std::string shape = R"({"type": "mesh", "material": "white", "file": "none.ply"})";
    EXPECT_EQ(refusal(SceneText{.shapes = shape}.text(), folder_.path()),
              "t.json: shapes[0].file: found \"none.ply\", expected a readable mesh (" +
                  (folder_.path() / "none.ply").string() +
                  ": found no file, expected an OBJ, PLY or glTF mesh)");
}

TEST_F(MeshFile, ASceneCountsTheFacesThatItDropped) {
    folder_.write("d.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n");
    const std::string shape = R"({"type": "mesh", "material": "white", "file": "d.obj"})";
    const Scene scene =
        parse_scene(SceneText{.shapes = shape + "," + shape}.text(), "t.json", folder_.path());
    EXPECT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(scene.degenerate_faces_dropped, 2u);
}

}  // namespace
}  // namespace regather::scenes
