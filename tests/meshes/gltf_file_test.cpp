// Containers, buffers and URIs of glTF.
#include "meshes/gltf_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/meshes/gltf_box.h"

namespace regather::meshes {
namespace {

using ::testing::HasSubstr;

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

}  // namespace
}  // namespace regather::meshes
