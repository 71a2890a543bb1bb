// Primitives and nodes of glTF, versions and what is not known.
#include "meshes/gltf.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/meshes/gltf_box.h"

namespace regather::meshes {
namespace {

using ::testing::HasSubstr;

// --- primitives ---

TEST(Gltf, StripsAndFansKeepTheirSides) {
    // A strip of 4 x 1 and a fan over half a hexagon's corners, both seen from above.
    const auto with = [](int mode, const std::vector<Vec3>& points) {
        std::string bytes;
        for (const Vec3 p : points)
            for (int axis = 0; axis < 3; ++axis) put(bytes, p[axis]);
        Parts parts;
        parts.buffers = fmt::format(R"([{{"byteLength": {}, "uri": "t.bin"}}])", bytes.size());
        parts.views = fmt::format(R"([{{"buffer": 0, "byteLength": {}}}])", bytes.size());
        parts.positions = fmt::format(
            R"("bufferView": 0, "componentType": 5126, "count": {}, "type": "VEC3")", points.size());
        parts.primitive = fmt::format(R"("attributes": {{"POSITION": 0}}, "mode": {})", mode);
        const Mesh mesh = read(parts, bytes);
        for (const auto& [a, b, c] : mesh.surface.triangles) {
            const Vec3 p = mesh.surface.vertices[a];
            EXPECT_GT(cross(mesh.surface.vertices[b] - p, mesh.surface.vertices[c] - p).z, 0);
        }
        return std::pair{mesh.surface.triangles.size(), area(mesh)};
    };
    EXPECT_EQ(with(5, {{0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {4, 1, 0}, {0, 3, 0}}),
              (std::pair<std::size_t, double>{3, 8}));
    EXPECT_EQ(with(6, {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {-1, 1, 0}}),
              (std::pair<std::size_t, double>{3, 7.5}));
    EXPECT_EQ(with(4, {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}}), (std::pair<std::size_t, double>{1, 3}));
}

TEST(Gltf, WhatIsNotATriangleIsNamed) {
    Parts parts;
    parts.primitive =
        R"("attributes": {"POSITION": 0, "COLOR_0": 0, "TEXCOORD_0": 0}, "indices": 1, "targets": [{"POSITION": 0}],
        "extensions": {"KHR_draco_mesh_compression": {}}}, {"mode": 0, "attributes": {"POSITION": 0}},
        {"mode": 1, "attributes": {"POSITION": 0}}, {"mode": 3, "attributes": {"POSITION": 0}}, {"attributes": {}},
        {"attributes": {"POSITION": 0})";
    parts.nodes = R"([{"mesh": 0, "camera": 0, "extensions": {"EXT_mesh_gpu_instancing": {}}}])";
    parts.more = R"(, "animations": [{}, {}], "cameras": [{}], "extensions": {"KHR_lights_punctual": {}})";
    const Mesh mesh = read(parts);
    EXPECT_EQ(mesh.surface.triangles.size(), 12u + 2);  // the last primitive: 8 corners make two triangles
    EXPECT_EQ(
        notes(mesh),
        "the attribute \"COLOR_0\" of vertices is not read: 1\nmorph targets are not applied: 1\n"
        "the extension \"KHR_draco_mesh_compression\" of triangles is not read: 1\n"
        "points are not read: 1\nlines are not read: 2\ntriangles without positions are left out: 1\n"
        "corners behind the last whole triangle are left out: 2\ncameras are not read: 1\n"
        "the extension \"EXT_mesh_gpu_instancing\" of nodes is not read: 1\nanimations are not played: 2\n"
        "the extension \"KHR_lights_punctual\" of the file is not read: 1\n");
    parts = {};
    parts.primitive = R"("attributes": {"POSITION": 0}, "mode": 7)";
    EXPECT_THAT(refused(parts), HasSubstr("mode: found 7, expected 0 to 6"));
}

TEST(Gltf, TrianglesWithoutAreaOrOfTooFewCornersAreNamed) {
    Parts parts;
    // The first four triangles of the box, then 0 0 1 and 5 2 5 in place of the fifth and the sixth.
    std::string bytes = box_bytes().substr(0, 96 + 24);
    for (const int i : {0, 0, 1, 5, 2, 5}) put(bytes, static_cast<std::uint16_t>(i));
    bytes += box_bytes().substr(bytes.size());
    const Mesh mesh = read(parts, bytes);
    EXPECT_EQ(mesh.surface.triangles.size(), 10u);
    EXPECT_EQ(mesh.degenerate_faces, 2u);
    EXPECT_EQ(notes(mesh), "triangles without area are left out: 2\n");
    for (const int mode : {4, 5, 6}) {
        parts.primitive = fmt::format(
            R"("attributes": {{"POSITION": 0}}, "indices": 1}}, {{"mode": {}, "attributes": {{"POSITION": 0}}, "indices": 2)",
            mode);
        parts.more_accessors = R"(, {"bufferView": 1, "componentType": 5123, "count": 2, "type": "SCALAR"})";
        expect_box(read(parts));
        EXPECT_EQ(notes(read(parts)),
                  "triangles (lists, strips, fans) of fewer than three corners are left out: 1\n");
    }
}

// --- nodes ---

TEST(Gltf, NodesPlaceTheMesh) {
    // Parent: 2 x, then moved by 10 along x. Child: a quarter turn about z, which takes (2, 3, 4) to (-3, 2,
    // 4).
    Parts parts;
    parts.nodes =
        R"([{"children": [1], "scale": [2, 2, 2], "translation": [10, 0, 0]}, {"mesh": 0, "rotation": [0, 0, 0.70710678118654752, 0.70710678118654752]}])";
    const Mesh mesh = read(parts);
    const trace::Bounds3 bounds = trace::bounds_of(mesh.surface.vertices);
    EXPECT_LT(length(bounds.min - Vec3{4, 0, 0}), 1e-5f);
    EXPECT_LT(length(bounds.max - Vec3{10, 4, 8}), 1e-5f);
    EXPECT_NEAR(volume(mesh), 8 * 24, 1e-3);
    // By columns: x to y, y to z, z to x, and moved by (1, 2, 3).
    parts.nodes = R"([{"mesh": 0, "matrix": [0,1,0,0, 0,0,1,0, 1,0,0,0, 1,2,3,1]}])";
    const Mesh turned = read(parts);
    EXPECT_EQ(trace::bounds_of(turned.surface.vertices).min, (Vec3{1, 2, 3}));
    EXPECT_EQ(trace::bounds_of(turned.surface.vertices).max, (Vec3{5, 4, 6}));
    EXPECT_NEAR(volume(turned), 24, 1e-5);
    parts.nodes = R"([{"mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0.5, 0,0,0,1]}])";
    EXPECT_THAT(refused(parts), HasSubstr("nodes[0].matrix: found a last row other than 0 0 0 1"));
    parts.nodes = R"([{"mesh": 0, "rotation": [0, 0, 0, 0]}])";
    EXPECT_THAT(refused(parts), HasSubstr("nodes[0].rotation: found a quaternion without a direction"));
    parts.nodes = R"([{"mesh": 0, "rotation": [0, 0, 0, 2]}])";
    expect_box(read(parts), "a quaternion of length 2");
}

TEST(Gltf, AMatrixStandsAlone) {
    Parts parts;
    for (const auto& [key, value] :
         {std::pair{"translation", "[0, 0, 7]"}, std::pair{"rotation", "[0, 0, 0, 1]"},
          std::pair{"scale", "[1, 5, 1]"}}) {
        parts.nodes = fmt::format(
            R"([{{"mesh": 0, "{}": {}, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1,2,3,1]}}])", key, value);
        EXPECT_EQ(refused(parts), fmt::format("t: line 1, nodes[0].{0}: found {0} beside a matrix, "
                                              "expected only one of them",
                                              key));
    }
}

TEST(Gltf, NodesThatNoSceneShowsAreNamed) {
    Parts parts;
    parts.scenes = R"("scene": 1, "scenes": [{"nodes": [2]}, {"nodes": [0]}], )";
    // 0: shown; 2 and its child 3: by another scene; 4 and its child 5, and 6: by none, 1 has no mesh.
    parts.nodes =
        R"([{"mesh": 0}, {}, {"mesh": 0, "children": [3]}, {"mesh": 0}, {"mesh": 0, "children": [5]},
            {"mesh": 0, "translation": [5, 0, 0]}, {"mesh": 0}])";
    expect_box(read(parts));
    EXPECT_EQ(notes(read(parts)),
              "nodes with a mesh that no scene shows are left out: 3\n"
              "scenes other than the default one are not read: 1\n");
    parts = {};
    parts.primitive += R"(}]}, {"primitives": [{"attributes": {"POSITION": 0})";
    expect_box(read(parts));
    EXPECT_EQ(notes(read(parts)), "meshes of no node are left out: 1\n");
}

TEST(Gltf, MirroringNodesStillFaceOutwardAndTurnNormals) {
    Parts parts;
    parts.primitive =
        R"("attributes": {"POSITION": 0, "NORMAL": 0}, "indices": 1)";  // normals away from the first corner
    for (const auto& [scale, extent] : {std::pair{"-1, 1, 1", Vec3{-2, 3, 4}},
                                        {"1, -2, 1", Vec3{2, -6, 4}},
                                        {"-1, -1, -1", Vec3{-2, -3, -4}}}) {
        parts.nodes = fmt::format(R"([{{"mesh": 0, "scale": [{}]}}])", scale);
        const Mesh mesh = read(parts);
        EXPECT_NEAR(volume(mesh), std::abs(extent.x * extent.y * extent.z), 1e-4) << scale;
        for (std::size_t v = 0; v < mesh.surface.vertices.size(); ++v) {
            const Vec3 n = mesh.surface.normals[v];
            EXPECT_GE(dot(n, mesh.surface.vertices[v]), 0) << scale;
        }
    }
}

TEST(Gltf, ANormalGoesByTheTransposedInverse) {
    // The plane x + y = 0 stretched along x by 4: its normal (1, 1, 0) becomes (1/4, 1, 0), not (4, 1, 0).
    std::string bytes;
    for (const float x :
         {0.f, 0.f, 0.f, 1.f, -1.f, 0.f, 0.f, 0.f, 1.f, 1.f, 1.f, 0.f, 1.f, 1.f, 0.f, 1.f, 1.f, 0.f})
        put(bytes, x);
    Parts parts;
    parts.buffers = R"([{"byteLength": 72, "uri": "t.bin"}])";
    parts.views = R"([{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 36}])";
    parts.positions = R"("bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3")";
    parts.indices = R"("bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3")";
    parts.primitive = R"("attributes": {"POSITION": 0, "NORMAL": 1})";
    parts.nodes = R"([{"mesh": 0, "scale": [4, 1, 1]}])";
    const Vec3 normal = read(parts, bytes).surface.normals[0];
    EXPECT_NEAR(normal.x / normal.y, 0.25, 1e-6);
    EXPECT_NEAR(length(normal), 1, 1e-6);
}

TEST(Gltf, TheNodeOfASkinnedMeshDoesNotPlaceIt) {
    Parts parts;
    parts.nodes = R"([{"mesh": 0, "skin": 0, "translation": [0, 50, 0], "scale": [1, 1, 5]}])";
    parts.more = R"(, "skins": [{"joints": [0]}])";
    const Mesh mesh = read(parts);
    expect_box(mesh);
    EXPECT_EQ(notes(mesh), "skins are not read: skinned meshes stand as they are bound: 1\n");
    parts.nodes = R"([{"mesh": 0, "skin": 7}])";
    EXPECT_EQ(refused(parts),
              "t: line 1, nodes[0].skin: found 7, expected a whole number below 1, one of skins");
    parts.more = "";
    EXPECT_EQ(refused(parts), "t: line 1, nodes[0].skin: found 7, expected none: the file has no skins");
}

TEST(Gltf, WithoutScenesAllRootsAreRead) {
    Parts parts;
    parts.scenes = "";
    parts.nodes =
        R"([{"mesh": 0}, {"children": [0], "translation": [0, 0, 5]}, {"mesh": 0, "translation": [0, 0, 50]}])";
    const Mesh mesh = read(parts);
    EXPECT_EQ(mesh.surface.triangles.size(), 24u);
    EXPECT_EQ(trace::bounds_of(mesh.surface.vertices).min.z, 5);
    EXPECT_EQ(trace::bounds_of(mesh.surface.vertices).max.z, 54);
    parts.scenes = R"("scenes": [{"nodes": [2]}, {"nodes": [1]}], )";
    EXPECT_EQ(trace::bounds_of(read(parts).surface.vertices).min.z, 50);
    parts.scenes = R"("scene": 1, "scenes": [{"nodes": [2]}, {"nodes": [1]}], )";
    EXPECT_EQ(trace::bounds_of(read(parts).surface.vertices).min.z, 5);
    EXPECT_EQ(notes(read(parts)), "scenes other than the default one are not read: 1\n");
}

TEST(Gltf, NodesInACircleOrTwiceAreRefusedAndDeepOnesRead) {
    Parts parts;
    parts.nodes = R"([{"children": [1]}, {"mesh": 0, "children": [0]}])";
    EXPECT_THAT(refused(parts), HasSubstr("nodes[0]: found a node in two places or in a circle"));
    parts.nodes = R"([{"children": [1, 1]}, {"mesh": 0}])";
    EXPECT_THAT(refused(parts), HasSubstr("nodes[1]: found a node in two places"));
    constexpr int deep = 20'000;
    parts.nodes = "[";
    for (int n = 0; n < deep; ++n) parts.nodes += fmt::format(R"({{"children": [{}]}}, )", n + 1);
    parts.nodes += R"({"mesh": 0}])";
    expect_box(read(parts));
}

// --- versions, extensions and what is not known ---

TEST(Gltf, OtherVersionsAndRequiredExtensionsAreRefused) {
    Parts parts;
    parts.asset = R"({"version": "1.0"})";
    EXPECT_EQ(refused(parts), "t: line 1, asset.version: found \"1.0\", expected glTF 2.0");
    parts.asset = R"({"version": "2.1", "minVersion": "2.1"})";
    EXPECT_THAT(refused(parts), HasSubstr("asset.minVersion: found \"2.1\", expected glTF 2.0"));
    parts = {};
    parts.more = R"(, "extensionsRequired": ["KHR_materials_unlit", "KHR_draco_mesh_compression"])";
    EXPECT_THAT(
        refused(parts),
        HasSubstr("extensionsRequired[1]: found the required extension \"KHR_draco_mesh_compression\""));
    EXPECT_THAT(refused(Format::gltf, "[1]"), HasSubstr("expected a glTF 2.0 file"));
    EXPECT_NE(refused(Format::gltf, ""), "");
    EXPECT_THAT(refused(Format::gltf, Parts{}.text() + "x"), HasSubstr("line 1"));
    std::string deep = "{\"asset\": ";
    for (int i = 0; i < 100'000; ++i) deep += "[";
    EXPECT_THAT(refused(Format::gltf, deep), HasSubstr("line 1"));
}

TEST(Gltf, UnknownKeysAreNamedALineAKind) {
    Parts parts;
    parts.asset = R"({"version": "2.0", "generator": "by hand", "extras": {"any": 1}, "autor": "me"})";
    parts.scenes = R"("scene": 0, "scenes": [{"nodes": [0, 1], "name": "s", "node": 7}], )";
    parts.nodes = R"([{"mesh": 0, "rotaton": [0, 0, 0, 1], "name": "n"}, {"rotaton": 1, "meshs": 0}])";
    parts.primitive = R"("attributes": {"POSITION": 0}, "indices": 1, "material": 0, "indizes": 3)";
    parts.material =
        R"("alphamode": "BLEND", "doubleSided": true, "pbrMetallicRoughness": {"metalicFactor": 1},
        "extensions": {"KHR_materials_ior": {"iro": 2}})";
    parts.buffers = R"([{"byteLength": 168, "uri": "t.bin", "size": 168}])";
    parts.views = R"([{"buffer": 0, "byteLength": 96, "bytestride": 12},
        {"buffer": 0, "byteOffset": 96, "byteLength": 72, "extensions": {"EXT_meshopt_compression": {}}}])";
    parts.positions += R"(, "min": [0, 0, 0], "max": [2, 3, 4], "normalised": true)";
    parts.more = R"(, "light": [], "extras": 1, "samplers": [])";
    const Mesh mesh = read(parts);
    expect_box(mesh);
    EXPECT_EQ(
        notes(mesh),
        "the key \"light\" of the file is not known: 1\nthe key \"autor\" of the asset is not known: 1\n"
        "the key \"node\" of scenes is not known: 1\nthe key \"rotaton\" of nodes is not known: 2\n"
        "the key \"meshs\" of nodes is not known: 1\nthe key \"indizes\" of primitives is not known: 1\n"
        "the key \"alphamode\" of materials is not known: 1\n"
        "the key \"metalicFactor\" of pbrMetallicRoughness is not known: 1\n"
        "the key \"iro\" of KHR_materials_ior is not known: 1\n"
        "the key \"normalised\" of accessors is not known: 1\n"
        "the key \"bytestride\" of bufferViews is not known: 1\n"
        "the extension \"EXT_meshopt_compression\" of bufferViews is not read: 1\n"
        "the key \"size\" of buffers is not known: 1\n");
    parts = {};
    parts.nodes = R"([{"mesh": 0}, 7])";
    EXPECT_EQ(refused(parts), "t: line 1, nodes[1]: found 7, expected an object");
}

TEST(Gltf, EveryCutOfItsTextIsRefused) {
    const std::string text = Parts{}.text();
    for (std::size_t length = 0; length < text.size(); ++length)
        EXPECT_NE(refused(Format::gltf, text.substr(0, length), {{"t.bin", box_bytes()}}), "") << length;
}

}  // namespace
}  // namespace regather::meshes
