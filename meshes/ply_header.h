// meshes/ply_header.h -- what the header of a PLY file declares.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace regather::meshes {

struct PlyType {
    std::string_view name, other_name;  ///< "uchar", "uint8".
    std::size_t bytes;
    enum Kind : std::uint8_t { whole_signed, whole_unsigned, real } kind;
};

struct PlyProperty {
    std::string name;
    const PlyType* length = nullptr;  ///< Of a list; null for a single value.
    const PlyType* value = nullptr;
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

enum class PlyForm : std::uint8_t { ascii, little_endian, big_endian };

struct PlyHeader {
    PlyForm form = PlyForm::ascii;
    std::vector<PlyElement> elements;
    std::size_t textures = 0;     ///< Comments of the form "TextureFile NAME".
    std::size_t body = 0;         ///< Where it begins, in bytes,
    std::uint64_t body_line = 1;  ///< and in lines.
};

/// Throws trace::DataError "FILE: line N: found X, expected Y" for lines that the format does not have,
/// elements and properties that stand twice, and a header without its end.
PlyHeader read_ply_header(std::string_view bytes, const std::string& file);

}  // namespace regather::meshes
