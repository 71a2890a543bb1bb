// tests/meshes/gltf_box.h -- the box of tests/meshes/parsed.h as glTF text and as GLB, with parts that a test
// replaces.
#pragma once
#include <cstdint>
#include <string>

#include "tests/meshes/parsed.h"

namespace regather::meshes {

/// The box: 96 bytes of positions as floats, then 72 of indices as shorts.
inline std::string box_bytes() {
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

inline Mesh read(const Parts& parts, const std::string& bytes = box_bytes()) {
    return parsed(Format::gltf, parts.text(), {{"t.bin", bytes}});
}
inline std::string refused(const Parts& parts, const std::string& bytes = box_bytes()) {
    return refused(Format::gltf, parts.text(), {{"t.bin", bytes}});
}

inline std::string chunk(const std::string& type, std::string content, char padding = ' ') {
    while (content.size() % 4 != 0) content += padding;
    std::string bytes;
    put(bytes, static_cast<std::uint32_t>(content.size()));
    return bytes + type + content;
}

inline std::string glb_of(const std::string& chunks, std::uint32_t version = 2) {
    std::string bytes = "glTF";
    put(bytes, version);
    put(bytes, static_cast<std::uint32_t>(12 + chunks.size()));
    return bytes + chunks;
}

inline const std::string bin_type("BIN\0", 4);

inline std::string glb() {
    Parts inside;
    inside.buffers = R"([{"byteLength": 168}])";
    return glb_of(chunk("JSON", inside.text()) + chunk(bin_type, box_bytes(), '\0'));
}

}  // namespace regather::meshes
