#include "meshes/gltf_accessor.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/meshes/gltf_box.h"

namespace regather::meshes {
namespace {

using ::testing::HasSubstr;

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
    EXPECT_THAT(refused(Parts{}, bytes), HasSubstr("accessors[0]: found element 3 that is not finite"));
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

}  // namespace
}  // namespace regather::meshes
