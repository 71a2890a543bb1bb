#include "meshes/gltf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <cstring>

#include "tests/scenes/closed_surface.h"
#include "tests/scenes/scene_text.h"

namespace regather::scenes {
namespace {

using ::testing::HasSubstr;

template <class Value>
void put(std::string& bytes, Value value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
}

// A tetrahedron with corners at 0 and the unit vectors: 48 bytes of positions, then 24 of indices.
std::string tetrahedron() {
    std::string bytes;
    for (const Vec3 p : {Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
        for (int axis = 0; axis < 3; ++axis) put(bytes, p[axis]);
    for (const std::uint16_t i : std::array<std::uint16_t, 12>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3})
        put(bytes, i);
    return bytes;
}

struct Parts {
    std::string nodes = R"([{"mesh": 0}])";
    std::string buffer = R"("byteLength": 72, "uri": "t.bin")";
    std::string views =
        R"([{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}])";
    std::string positions = R"("bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3")";
    std::string indices = R"("bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR")";
    std::string more{};

    std::string text() const {
        return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": )" + nodes +
               R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
               "materials": [{"name": "blue", "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.9, 1], "metallicFactor": 0, "roughnessFactor": 1}}],
               "buffers": [{)" +
               buffer + R"(}], "bufferViews": )" + views + R"(, "accessors": [{)" + positions + "}, {" +
               indices + "}]" + more + "}";
    }
};

std::string glb(std::string json, const std::string& binary) {
    while (json.size() % 4 != 0) json += ' ';
    std::string bytes = "glTF";
    put(bytes, std::uint32_t{2});
    put(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + binary.size()));
    put(bytes, static_cast<std::uint32_t>(json.size()));
    bytes += "JSON" + json;
    put(bytes, static_cast<std::uint32_t>(binary.size()));
    bytes += std::string("BIN\0", 4) + binary;
    return bytes;
}

class GltfFile : public ::testing::Test {
protected:
    GltfFile() { folder_.write("t.bin", tetrahedron()); }
    Mesh read(const Parts& parts) { return read_mesh(folder_.write("t.gltf", parts.text())); }
    std::string refused(const std::string& name, const std::string& content) {
        const std::filesystem::path file = folder_.write(name, content);
        try {
            read_mesh(file);
        } catch (const trace::DataError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            return error.what();
        }
        return "";
    }
    std::string refused(const Parts& parts) { return refused("t.gltf", parts.text()); }
    ScratchFolder folder_;
};

TEST_F(GltfFile, ATetrahedronIsReadFromGltfAndGlbAlike) {
    Parts inside;
    inside.buffer = R"("byteLength": 72)";
    for (const std::filesystem::path& file : {folder_.write("a.gltf", Parts{}.text()),
                                              folder_.write("b.GLB", glb(inside.text(), tetrahedron()))}) {
        const Mesh mesh = read_mesh(file);
        EXPECT_EQ(mesh.surface.triangles.size(), 4u);
        EXPECT_EQ(unpaired_edges(mesh.surface.vertices, mesh.surface.triangles), 0u);
        EXPECT_NEAR(volume(mesh.surface.vertices, mesh.surface.triangles), 1.0 / 6, 1e-7);
        ASSERT_EQ(mesh.materials.size(), 1u);
        EXPECT_EQ(mesh.materials[0].name, "blue");
        EXPECT_EQ(mesh.materials[0].kind, MaterialKind::diffuse);
        EXPECT_EQ(mesh.materials[0].diffuse, (Vec3{0.1f, 0.2f, 0.9f}));
        EXPECT_EQ(mesh.triangle_material, (std::vector<std::uint32_t>(4, 0)));
    }
}

TEST_F(GltfFile, ADataUriIsABufferToo) {
    // Three floats 0 and three 1, by hand: 0x3f800000 is "AACAPw==" in base64, little-endian.
    Parts parts;
    parts.buffer =
        R"("byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA")";
    parts.views = R"([{"buffer": 0, "byteLength": 36}])";
    parts.positions = R"("bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3")";
    std::string text = parts.text();
    text.replace(text.find(R"(, "indices": 1)"), 14, "");
    const Mesh mesh = read_mesh(folder_.write("d.gltf", text));
    ASSERT_EQ(mesh.surface.triangles.size(), 1u);
    EXPECT_EQ(mesh.surface.vertices[1], (Vec3{1, 0, 0}));
    EXPECT_EQ(mesh.surface.vertices[2], (Vec3{0, 1, 0}));
}

TEST_F(GltfFile, NodesPlaceTheMesh) {
    // Parent: 2 x, then moved by 10 along x. Child: a quarter turn about z, which takes (1, 0, 0) to (0, 1,
    // 0).
    Parts parts;
    parts.nodes =
        R"([{"children": [1], "scale": [2, 2, 2], "translation": [10, 0, 0]}, {"mesh": 0, "rotation": [0, 0, 0.70710678118654752, 0.70710678118654752]}])";
    const Mesh mesh = read(parts);
    EXPECT_LT(length(mesh.surface.vertices[1] - Vec3{10, 2, 0}), 1e-5f);
    EXPECT_LT(length(mesh.surface.vertices[2] - Vec3{8, 0, 0}), 1e-5f);
    EXPECT_NEAR(volume(mesh.surface.vertices, mesh.surface.triangles), 8.0 / 6, 1e-5);
}

TEST_F(GltfFile, AMirroringNodeStillFacesOutward) {
    Parts parts;
    parts.nodes = R"([{"mesh": 0, "matrix": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}])";
    const Mesh mesh = read(parts);
    EXPECT_EQ(mesh.surface.vertices[1], (Vec3{-1, 0, 0}));
    EXPECT_NEAR(volume(mesh.surface.vertices, mesh.surface.triangles), 1.0 / 6, 1e-7);
}

TEST_F(GltfFile, ASmallFileThatDeclaresABillionIsRefusedInBoundedMemory) {
    rusage before{};
    getrusage(RUSAGE_SELF, &before);
    Parts parts;
    parts.positions = R"("bufferView": 0, "componentType": 5126, "count": 1000000000, "type": "VEC3")";
    EXPECT_THAT(refused(parts),
                HasSubstr("accessor 0 of 1000000000 elements at byte 0, expected what fits the 48 bytes"));
    parts = {};
    parts.positions =
        R"("bufferView": 0, "componentType": 5126, "count": 18446744073709551615, "type": "VEC3")";
    EXPECT_THAT(refused(parts), HasSubstr("18446744073709551615"));
    parts = {};
    parts.positions = R"("componentType": 5126, "count": 1000000000, "type": "VEC3", "sparse": {})";
    EXPECT_THAT(refused(parts), HasSubstr("accessor 0 without a bufferView, or sparse"));
    parts = {};
    parts.buffer = R"("byteLength": 9000000000, "uri": "t.bin")";
    EXPECT_THAT(refused(parts), HasSubstr("buffer 0 of 72 bytes, expected the 9000000000 that it declares"));
    rusage after{};
    getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 * 1024);  // [KiB]
}

TEST_F(GltfFile, WhatLeadsBeyondItsBytesIsRefused) {
    Parts parts;
    parts.positions =
        R"("bufferView": 0, "byteOffset": 4, "componentType": 5126, "count": 4, "type": "VEC3")";
    EXPECT_THAT(refused(parts), HasSubstr("accessor 0 of 4 elements at byte 4"));
    parts = {};
    parts.views = R"([{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 60, "byteLength": 24}])";
    EXPECT_THAT(refused(parts),
                HasSubstr("a bufferView of 24 bytes at 60, expected at most the buffer's 72"));
    parts = {};
    parts.views = R"([{"buffer": 0, "byteLength": 48}, {"buffer": 1, "byteLength": 24}])";
    EXPECT_THAT(refused(parts), HasSubstr("buffer 1, expected one of 1"));
    parts = {};
    parts.positions = R"("bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3")";
    EXPECT_THAT(refused(parts), HasSubstr("index 3 of 3 vertices"));
    parts = {};
    parts.nodes = R"([{"mesh": 7}])";
    EXPECT_THAT(refused(parts), HasSubstr("meshes 7, expected one of 1"));
    parts = {};
    parts.buffer = R"("byteLength": 72, "uri": "gone.bin")";
    EXPECT_THAT(refused(parts), HasSubstr("gone.bin: found no file, expected a buffer of"));
    parts = {};
    parts.more = R"(, "extensionsRequired": ["KHR_draco_mesh_compression"])";
    EXPECT_THAT(refused(parts), HasSubstr("the required extension \"KHR_draco_mesh_compression\""));
}

TEST_F(GltfFile, NodesInACircleOrTwiceAreRefused) {
    Parts parts;
    parts.nodes = R"([{"children": [1]}, {"mesh": 0, "children": [0]}])";
    EXPECT_THAT(refused(parts), HasSubstr("node 0 in two places"));
    parts.nodes = R"([{"children": [1, 1]}, {"mesh": 0}])";
    EXPECT_THAT(refused(parts), HasSubstr("node 1 in two places"));
}

TEST_F(GltfFile, AnyCutIsRefused) {
    Parts inside;
    inside.buffer = R"("byteLength": 72)";
    const std::string binary = glb(inside.text(), tetrahedron()), text = Parts{}.text();
    for (std::size_t length = 0; length < binary.size(); ++length)
        EXPECT_NE(refused("c.glb", binary.substr(0, length)), "") << length;
    for (std::size_t length = 0; length < text.size(); ++length)
        EXPECT_NE(refused("c.gltf", text.substr(0, length)), "") << length;
}

TEST_F(GltfFile, AnyChangedByteIsRefusedOrReadWithoutHarm) {
    Parts inside;
    inside.buffer = R"("byteLength": 72)";
    const std::string whole = glb(inside.text(), tetrahedron());
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const char c : {'\0', '9', '"', '\xff'}) {
            std::string damaged = whole;
            damaged[at] = c;
            refused("x.glb", damaged);
        }
}

TEST_F(GltfFile, ASceneTurnsYUpToZUp) {
    folder_.write("t.gltf", Parts{}.text());
    const std::string shape = R"({"type": "mesh", "file": "t.gltf", "up_axis": "y"})";
    const Scene scene = parse_scene(SceneText{.shapes = shape}.text(), "t.json", folder_.path());
    // The file's y is up: its (0, 1, 0) stands at (0, 0, 1), and its (0, 0, 1), towards the viewer, at (0,
    // -1, 0).
    EXPECT_EQ(scene.vertices[1], (Vec3{1, 0, 0}));
    EXPECT_EQ(scene.vertices[2], (Vec3{0, 0, 1}));
    EXPECT_EQ(scene.vertices[3], (Vec3{0, -1, 0}));
    EXPECT_EQ(scene.materials[scene.triangle_material[0]].name, "blue");
}

}  // namespace
}  // namespace regather::scenes
