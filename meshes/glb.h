// meshes/glb.h -- the container of a .glb file (Khronos Group, "glTF 2.0 Specification", section 4) and the
// URIs that glTF files name buffers by.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "meshes/notes.h"

namespace regather::meshes {

struct Glb {
    std::string_view json;
    std::optional<std::string_view> binary;  ///< The first BIN chunk.
};

bool is_glb(std::string_view bytes);

/// Other chunks, and bytes behind the container's end, are noted. Throws trace::DataError that names the file
/// and the byte for another version, and for chunks that are cut or lie beyond the end.
Glb read_glb(std::string_view bytes, const std::string& file, Notes& notes);

/// The bytes of a text in base64 (RFC 4648, section 4), with or without padding; none when it is no such
/// text.
std::optional<std::string> from_base64(std::string_view text);

/// With each %XX as the byte that it stands for; other percent signs stay.
std::string without_percent_codes(std::string_view uri);

/// Whether it opens with a scheme ("http:"), or is absolute ("/a", "\\host\a").
bool leaves_the_disk_or_is_absolute(std::string_view uri);

}  // namespace regather::meshes
