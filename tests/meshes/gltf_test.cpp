#include "meshes/gltf.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/meshes/parsed.h"

namespace regather::meshes {
namespace {

using ::testing::HasSubstr;

// The box: 96 bytes of positions as floats, then 72 of indices as shorts.
std::string box_bytes() {
    std::string bytes;
    for (const auto& corner : box_corners)
        for (const int x : corner) put(bytes, static_cast<float>(x));
    for (const auto& [a, b, c, d] : box_faces)
        for (const int i : {a, b, c, a, c, d}) put(bytes, static_cast<std::uint16_t>(i));
    return bytes;
}

/// A file with one part replaced at a time.
struct Parts {
    std::string asset = R"({"version": "2.0"})";
    std::string scenes = R"("scene": 0, "scenes": [{"nodes": [0]}], )";
    std::string nodes = R"([{"mesh": 0}])";
    std::string primitive = R"("attributes": {"POSITION": 0}, "indices": 1, "material": 0)";
    std::string material =
        R"("name": "blue", "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.9, 1], "metallicFactor": 0, "roughnessFactor": 1})";
    std::string buffers = R"([{"byteLength": 168, "uri": "t.bin"}])";
    std::string views =
        R"([{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}])";
    std::string positions = R"("bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3")";
    std::string indices = R"("bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR")";
    std::string more_accessors{}, more{};

    std::string text() const {
        return R"({"asset": )" + asset + ", " + scenes + R"("nodes": )" + nodes +
               R"(, "meshes": [{"primitives": [{)" + primitive + R"(}]}], "materials": [{)" + material +
               R"(}], "buffers": )" + buffers + R"(, "bufferViews": )" + views + R"(, "accessors": [{)" +
               positions + "}, {" + indices + "}" + more_accessors + "]" + more + "}";
    }
};

Mesh read(const Parts& parts, const std::string& bytes = box_bytes()) {
    return parsed(Format::gltf, parts.text(), {{"t.bin", bytes}});
}
std::string refused(const Parts& parts, const std::string& bytes = box_bytes()) {
    return refused(Format::gltf, parts.text(), {{"t.bin", bytes}});
}

std::string chunk(const std::string& type, std::string content, char padding = ' ') {
    while (content.size() % 4 != 0) content += padding;
    std::string bytes;
    put(bytes, static_cast<std::uint32_t>(content.size()));
    return bytes + type + content;
}

std::string glb_of(const std::string& chunks, std::uint32_t version = 2) {
    std::string bytes = "glTF";
    put(bytes, version);
    put(bytes, static_cast<std::uint32_t>(12 + chunks.size()));
    return bytes + chunks;
}

const std::string bin_type("BIN\0", 4);

std::string glb() {
    Parts inside;
    inside.buffers = R"([{"byteLength": 168}])";
    return glb_of(chunk("JSON", inside.text()) + chunk(bin_type, box_bytes(), '\0'));
}

// --- containers, buffers and URIs ---

TEST(Gltf, ABoxIsReadFromTextAndFromAGlb) {
    for (const Mesh& mesh : {read({}), parsed(Format::gltf, glb())}) {
        expect_box(mesh);
        ASSERT_EQ(mesh.materials.size(), 1u);
        EXPECT_EQ(mesh.materials[0].name, "blue");
        const auto& terms = std::get<MetallicRoughness>(mesh.materials[0].terms);
        EXPECT_EQ(terms.base_color, (Vec3{0.1f, 0.2f, 0.9f}));
        EXPECT_EQ(terms.metallic, 0);
        EXPECT_EQ(mesh.triangle_material, (std::vector<std::uint32_t>(12, 0)));
        EXPECT_EQ(notes(mesh), "");
    }
}

TEST(Gltf, FurtherChunksAndBytesAreNamed) {
    Parts inside;
    inside.buffers = R"([{"byteLength": 168}])";
    const std::string json = chunk("JSON", inside.text()), bin = chunk(bin_type, box_bytes());
    const Mesh mesh = parsed(Format::gltf, glb_of(json + bin + chunk("NOTE", "hello") + bin) + "12345");
    expect_box(mesh);
    EXPECT_EQ(notes(mesh),
              "bytes behind the end of the GLB are not read: 5\nfurther chunks of the GLB are not read: 2\n");
}

TEST(Gltf, DamagedGlbsAreRefusedWithTheByte) {
    const std::string whole = glb();
    EXPECT_EQ(refused(Format::gltf, "glTF"), "t: byte 5: found the end of the file, expected a GLB header");
    EXPECT_EQ(refused(Format::gltf, glb_of("", 1)), "t: byte 5: found version 1 of GLB, expected 2");
    EXPECT_EQ(refused(Format::gltf, glb_of("")),
              "t: byte 13: found the end of the file, expected a JSON chunk");
    EXPECT_THAT(refused(Format::gltf, glb_of(chunk(bin_type, "1234"))),
                HasSubstr("byte 13: found a chunk of another type"));
    EXPECT_THAT(refused(Format::gltf, glb_of(chunk("JSON", "{}") + chunk("JSON", "{}"))),
                HasSubstr("byte 25: found a second JSON chunk"));
    EXPECT_THAT(refused(Format::gltf, glb_of(chunk("JSON", Parts{}.text()) + "1234")),
                HasSubstr("found a chunk that is cut"));
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_NE(refused(Format::gltf, whole.substr(0, length)), "") << length;
}

TEST(Gltf, ADataUriIsABuffer) {
    // Three floats 0, then (1, 0, 0), (0, 2, 0): 0x3f800000 and 0x40000000, little-endian.
    Parts parts;
    parts.buffers =
        R"([{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAA"}])";
    parts.views = R"([{"buffer": 0, "byteLength": 36}])";
    parts.positions = R"("bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3")";
    parts.primitive = R"("attributes": {"POSITION": 0})";
    EXPECT_EQ(read(parts).surface.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}));
    for (const std::string bad : {"AAAA*AAA", "AAAAA", "AA=A", "AAA===", "A A="}) {
        parts.buffers = R"([{"byteLength": 1, "uri": "data:;base64,)" + bad + R"("}])";
        EXPECT_THAT(refused(parts),
                    HasSubstr("buffers[0].uri: found a data URI with damaged base64, expected whole base64"))
            << bad;
    }
    parts.buffers = R"([{"byteLength": 1, "uri": "data:,abc"}])";
    EXPECT_THAT(refused(parts), HasSubstr("found a data URI that is not in base64"));
}

TEST(Gltf, UrisAreNamesRelativeToTheFile) {
    const auto with = [](const std::string& uri, const std::string& name) {
        Parts parts;
        parts.buffers = R"([{"byteLength": 168, "uri": ")" + uri + R"("}])";
        return refused(Format::gltf, parts.text(), {{name, box_bytes()}});
    };
    EXPECT_EQ(with("my%20box%2Ebin", "my box.bin"), "");
    EXPECT_EQ(with("100%.bin", "100%.bin"), "");
    EXPECT_EQ(with("a%20b.bin", "a%20b.bin"), "");  // a name that really holds a percent sign
    EXPECT_EQ(with("../parts/box.bin", "../parts/box.bin"), "");
    for (const std::string uri :
         {"/box.bin", "file:///box.bin", "http://a/box.bin", "C:/box.bin", "\\\\\\\\host\\\\box.bin"})
        EXPECT_THAT(with(uri, uri), HasSubstr("expected a data URI, or a name relative to the file")) << uri;
    EXPECT_THAT(
        with("gone.bin", "box.bin"),
        HasSubstr("t: line 1, buffers[0].uri: found \"gone.bin\", where no file is, expected a file"));
    EXPECT_THAT(with("box.bin%00.png", std::string("box.bin\0.png", 12)), HasSubstr("where no file is"));
}

TEST(Gltf, WhatLeadsBeyondItsBytesIsRefused) {
    Parts parts;
    parts.buffers = R"([{"byteLength": 169, "uri": "t.bin"}])";
    EXPECT_THAT(refused(parts), HasSubstr("buffers[0].byteLength: found 169 for a buffer of 168 bytes"));
    parts = {};
    parts.buffers = R"([{"byteLength": 168}])";
    EXPECT_THAT(refused(parts), HasSubstr("buffers[0]: found a buffer without a uri"));
    parts = {};
    parts.positions =
        R"("bufferView": 0, "byteOffset": 4, "componentType": 5126, "count": 8, "type": "VEC3")";
    EXPECT_THAT(refused(parts), HasSubstr("accessors[0].count: found 8 elements of 12 bytes from byte 4 on, "
                                          "expected what fits the 96 bytes"));
    parts = {};
    parts.views = R"([{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 100, "byteLength": 72}])";
    EXPECT_THAT(
        refused(parts),
        HasSubstr("bufferViews[1]: found 72 bytes at byte 100, expected no more than the buffer's 168"));
    parts = {};
    parts.views = R"([{"buffer": 0, "byteLength": 96}, {"buffer": 1, "byteLength": 72}])";
    EXPECT_THAT(refused(parts),
                HasSubstr("bufferViews[1].buffer: found 1, expected a whole number below 1, one of buffers"));
    parts = {};
    parts.positions = R"("bufferView": 0, "componentType": 5126, "count": 7, "type": "VEC3")";
    EXPECT_THAT(refused(parts),
                HasSubstr("accessors[1]: found the index 7 at 11, expected one of 7 vertices"));
    parts = {};
    parts.nodes = R"([{"mesh": 7}])";
    EXPECT_THAT(refused(parts), HasSubstr("nodes[0].mesh: found 7"));
    parts.nodes = R"([{"mesh": -1}])";
    EXPECT_THAT(refused(parts), HasSubstr("nodes[0].mesh: found -1"));
    parts.nodes = R"([{"mesh": "0"}])";
    EXPECT_THAT(refused(parts), HasSubstr("nodes[0].mesh: found \"0\""));
}

TEST(Gltf, ASmallFileThatDeclaresABillionIsRefusedInBoundedMemory) {
    rusage before{};
    getrusage(RUSAGE_SELF, &before);
    for (const std::string count : {"1000000000", "18446744073709551615"}) {
        Parts parts;
        parts.positions = R"("bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )" + count;
        EXPECT_THAT(refused(parts), HasSubstr("found " + count + " elements"));
        parts.positions = R"("componentType": 5126, "type": "VEC3", "sparse": {}, "count": )" + count;
        EXPECT_THAT(refused(parts), HasSubstr("accessors[0]: found an accessor without a bufferView"));
        parts = {};
        parts.primitive = R"("attributes": {"POSITION": 0}, "mode": 5, "indices": 1)";
        parts.indices = R"("bufferView": 1, "componentType": 5121, "type": "SCALAR", "count": )" + count;
        EXPECT_THAT(refused(parts), HasSubstr("found"));
        parts = {};
        parts.buffers = R"([{"uri": "t.bin", "byteLength": )" + count + "}]";
        EXPECT_THAT(refused(parts), HasSubstr("for a buffer of 168 bytes"));
    }
    rusage after{};
    getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 * 1024);  // [KiB]
}

// --- accessors ---

TEST(Gltf, ElementsMayLieApartAndAnywhere) {
    // Each position 20 bytes behind the one before, the first at byte 3 + 4.
    std::string bytes = "abc";
    for (const auto& corner : box_corners) {
        put(bytes, 99.0f);
        for (const int x : corner) put(bytes, static_cast<float>(x));
        put(bytes, 77.0f);
    }
    const std::size_t second = bytes.size();
    bytes += box_bytes().substr(96);
    Parts parts;
    parts.buffers = fmt::format(R"([{{"byteLength": {}, "uri": "t.bin"}}])", bytes.size());
    parts.views = fmt::format(
        R"([{{"buffer": 0, "byteOffset": 3, "byteLength": 160, "byteStride": 20}}, {{"buffer": 0, "byteOffset": {}, "byteLength": 72}}])",
        second);
    parts.positions =
        R"("bufferView": 0, "byteOffset": 4, "componentType": 5126, "count": 8, "type": "VEC3")";
    expect_box(read(parts, bytes));
}

template <class Index>
void expect_box_with_indices(int component) {
    std::string bytes = box_bytes().substr(0, 96);
    for (const auto& [a, b, c, d] : box_faces)
        for (const int i : {a, b, c, a, c, d}) put(bytes, static_cast<Index>(i));
    Parts parts;
    parts.buffers = fmt::format(R"([{{"byteLength": {}, "uri": "t.bin"}}])", bytes.size());
    parts.views = fmt::format(
        R"([{{"buffer": 0, "byteLength": 96}}, {{"buffer": 0, "byteOffset": 96, "byteLength": {}}}])",
        36 * sizeof(Index));
    parts.indices =
        fmt::format(R"("bufferView": 1, "componentType": {}, "count": 36, "type": "SCALAR")", component);
    expect_box(read(parts, bytes));
}

TEST(Gltf, IndicesOfEveryType) {
    expect_box_with_indices<std::uint8_t>(5121);
    expect_box_with_indices<std::uint16_t>(5123);
    expect_box_with_indices<std::uint32_t>(5125);
    Parts parts;
    parts.indices = R"("bufferView": 1, "componentType": 5122, "count": 36, "type": "SCALAR")";
    EXPECT_THAT(refused(parts), HasSubstr("found 5122, expected 5121, 5123 or 5125 for indices"));
}

TEST(Gltf, QuantizedPositionsAreReadAsTheSpecificationSays) {
    // One triangle; its second corner is the largest value of the type, its third the smallest.
    const auto positions = [](int component, bool normalized, auto largest, auto smallest) {
        using Value = decltype(largest);
        std::string bytes;
        for (const Value x :
             {Value{}, Value{}, Value{}, largest, Value{}, Value{}, Value{}, smallest, static_cast<Value>(1)})
            put(bytes, x);
        Parts parts;
        parts.buffers = fmt::format(R"([{{"byteLength": {}, "uri": "t.bin"}}])", bytes.size());
        parts.views = fmt::format(R"([{{"buffer": 0, "byteLength": {}}}])", bytes.size());
        parts.positions = fmt::format(
            R"("bufferView": 0, "componentType": {}, "count": 3, "type": "VEC3", "normalized": {})",
            component, normalized);
        parts.primitive = R"("attributes": {"POSITION": 0})";
        parts.more = R"(, "extensionsRequired": ["KHR_mesh_quantization"])";
        return read(parts, bytes).surface.vertices;
    };
    EXPECT_EQ(positions(5120, true, std::int8_t{127}, std::int8_t{-128}),
              (std::vector<Vec3>{{}, {1, 0, 0}, {0, -1, 1 / 127.0f}}));
    EXPECT_EQ(positions(5121, true, std::uint8_t{255}, std::uint8_t{51}),
              (std::vector<Vec3>{{}, {1, 0, 0}, {0, 0.2f, 1 / 255.0f}}));
    EXPECT_EQ(positions(5122, true, std::int16_t{32767}, std::int16_t{-32768}),
              (std::vector<Vec3>{{}, {1, 0, 0}, {0, -1, 1 / 32767.0f}}));
    EXPECT_EQ(positions(5123, true, std::uint16_t{65535}, std::uint16_t{13107}),
              (std::vector<Vec3>{{}, {1, 0, 0}, {0, 0.2f, 1 / 65535.0f}}));
    EXPECT_EQ(positions(5120, false, std::int8_t{127}, std::int8_t{-128}),
              (std::vector<Vec3>{{}, {127, 0, 0}, {0, -128, 1}}));
    EXPECT_EQ(positions(5123, false, std::uint16_t{65535}, std::uint16_t{7}),
              (std::vector<Vec3>{{}, {65535, 0, 0}, {0, 7, 1}}));
}

TEST(Gltf, SparsePositionsReplaceThoseOfTheView) {
    // The box 1 lower at its four upper corners; sparse values lift them to 4.
    std::string bytes;
    for (const auto& [x, y, z] : box_corners)
        for (const int v : {x, y, z == 4 ? 3 : z}) put(bytes, static_cast<float>(v));
    bytes += box_bytes().substr(96);
    for (const int i : {4, 5, 6, 7}) put(bytes, static_cast<std::uint16_t>(i));
    for (const std::size_t i : {4, 5, 6, 7})
        for (const int x : box_corners[i]) put(bytes, static_cast<float>(x));
    Parts parts;
    parts.buffers = R"([{"byteLength": 224, "uri": "t.bin"}])";
    parts.views =
        R"([{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}, {"buffer": 0, "byteOffset": 168, "byteLength": 56}])";
    const std::string sparse =
        R"("bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "sparse": {"count": 4, "indices": {"bufferView": 2, "componentType": 5123}, "values": {"bufferView": 2, "byteOffset": 8}})";
    parts.positions = sparse;
    expect_box(read(parts, bytes));
    parts.positions.replace(sparse.find("5123"), 4, "5125");  // 4 + 65536 * 5
    EXPECT_THAT(refused(parts, bytes),
                HasSubstr("accessors[0].sparse.indices: found the index 327684, expected one below 8"));
    parts.positions = sparse;
    parts.positions.replace(sparse.find("\"count\": 4"), 10, "\"count\": 5");
    EXPECT_THAT(refused(parts, bytes), HasSubstr("accessors[0].sparse.values: found 5 elements of 12 bytes"));
}

TEST(Gltf, NumbersThatAreNotFiniteAndOddTypesAreRefused) {
    std::string bytes = box_bytes();
    bytes.replace(12 * 3, 4, "\0\0\xc0\x7f", 4);
    EXPECT_THAT(refused({}, bytes), HasSubstr("accessors[0]: found element 3 that is not finite"));
    Parts parts;
    parts.positions = R"("bufferView": 0, "componentType": 5125, "count": 8, "type": "VEC3")";
    EXPECT_THAT(refused(parts), HasSubstr("accessors[0].componentType: found 5125"));
    parts.positions = R"("bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC2")";
    EXPECT_THAT(refused(parts), HasSubstr("accessors[0].type: found \"VEC2\", expected \"VEC3\""));
    parts = {};
    parts.views =
        R"([{"buffer": 0, "byteLength": 96, "byteStride": 8}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}])";
    EXPECT_THAT(refused(parts), HasSubstr("bufferViews[0].byteStride: found 8, expected 12 to 1024"));
    parts = {};
    parts.primitive = R"("attributes": {"POSITION": 0, "NORMAL": 2}, "indices": 1)";
    parts.more_accessors = R"(, {"bufferView": 0, "componentType": 5126, "count": 7, "type": "VEC3"})";
    EXPECT_THAT(refused(parts), HasSubstr("NORMAL: found 7 normals, expected one for each of 8 positions"));
}

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

// --- versions, extensions and materials ---

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

TEST(Gltf, MaterialsAreReadByTheirFactors) {
    Parts parts;
    parts.material = R"("alphaMode": "BLEND", "emissiveFactor": [1, 0.5, 0.25],
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 0.75], "metallicFactor": 0.3, "roughnessFactor": 0.2,
                                 "baseColorTexture": {"index": 0}},
        "normalTexture": {"index": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.9}, "KHR_materials_ior": {"ior": 1.33},
                       "KHR_materials_emissive_strength": {"emissiveStrength": 8}, "KHR_materials_sheen": {}})";
    const Mesh mesh = read(parts);
    EXPECT_EQ(mesh.materials[0].name, "material 0");
    EXPECT_EQ(mesh.materials[0].emission, (Vec3{8, 4, 2}));
    const auto& terms = std::get<MetallicRoughness>(mesh.materials[0].terms);
    EXPECT_EQ(terms.base_color, (Vec3{0.5f, 0.25f, 0.125f}));
    EXPECT_EQ(terms.alpha, 0.75f);
    EXPECT_EQ(terms.metallic, 0.3f);
    EXPECT_EQ(terms.roughness, 0.2f);
    EXPECT_EQ(terms.transmission, 0.9f);
    EXPECT_EQ(terms.index_of_refraction, 1.33f);
    EXPECT_EQ(notes(mesh),
              "textures of materials are not read: 2\n"
              "the extension \"KHR_materials_sheen\" of materials is not read: 1\n"
              "materials that emit light (emissiveFactor) do not shine: 1\n");
    parts.material = R"("alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.1]})";
    EXPECT_EQ(std::get<MetallicRoughness>(read(parts).materials[0].terms).alpha, 1);
    EXPECT_EQ(notes(read(parts)), "alpha masks of materials are not applied: 1\n");
    parts.material = R"("pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1]})";
    EXPECT_THAT(refused(parts), HasSubstr("materials[0].pbrMetallicRoughness.baseColorFactor: found a list "
                                          "of 3, expected a list of 4 numbers"));
    parts = {};
    parts.primitive = R"("attributes": {"POSITION": 0}, "indices": 1)";
    const Mesh plain = read(parts);
    EXPECT_EQ(plain.materials[plain.triangle_material[0]].name, "default");
}

TEST(Gltf, FactorsOutsideTheirRangesAreRefused) {
    const auto with = [](const std::string& material) {
        Parts parts;
        parts.material = material;
        return refused(parts);
    };
    const std::string share = ", expected a number from 0 to 1", at = "t: line 1, materials[0].";
    for (const auto& [key, value] : {std::pair{"metallicFactor", "5"}, std::pair{"roughnessFactor", "-3"}})
        EXPECT_EQ(with(fmt::format(R"("pbrMetallicRoughness": {{"{}": {}}})", key, value)),
                  fmt::format("{}pbrMetallicRoughness.{}: found {}{}", at, key, value, share));
    EXPECT_EQ(with(R"("pbrMetallicRoughness": {"baseColorFactor": [0.25, 2, 0, 1]})"),
              at + "pbrMetallicRoughness.baseColorFactor[1]: found 2" + share);
    EXPECT_EQ(with(R"("pbrMetallicRoughness": {"baseColorFactor": [0.25, 0, -1, 1]})"),
              at + "pbrMetallicRoughness.baseColorFactor[2]: found -1" + share);
    EXPECT_EQ(with(R"("emissiveFactor": [0.5, 1, 1.5])"), at + "emissiveFactor[2]: found 1.5" + share);
    EXPECT_EQ(with(R"("extensions": {"KHR_materials_transmission": {"transmissionFactor": 1.25}})"),
              at + "extensions.KHR_materials_transmission.transmissionFactor: found 1.25" + share);
    EXPECT_EQ(
        with(R"("extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": -8}})"),
        at + "extensions.KHR_materials_emissive_strength.emissiveStrength: found -8, expected a number of "
             "0 or more");
    EXPECT_EQ(with(R"("extensions": {"KHR_materials_ior": {"ior": -1.5}})"),
              at + "extensions.KHR_materials_ior.ior: found -1.5, expected a number of 0 or more");
    EXPECT_EQ(with(R"("alphaMode": "blend")"),
              at + "alphaMode: found \"blend\", expected \"OPAQUE\", \"MASK\" or \"BLEND\"");
    EXPECT_EQ(with(R"("alphaMode": "OPAQUE", "pbrMetallicRoughness": {"baseColorFactor": [0, 1, 0.5, 1]})"),
              "");
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
