// imports/texture.h -- image files of scenes that others made, decoded: JPEG, PNG and Targa.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trace/error.h"

namespace regather::imports {

struct Texture {
    std::uint32_t width = 0, height = 0;
    /// sRGB and how much the texel covers (255 where the file does not say). In the file's order of rows.
    std::vector<std::array<std::uint8_t, 4>> texels;
};

inline constexpr std::uint32_t most_texture_edge = 8192;  ///< Texels.

/// What the bytes are is told by their first ones (JPEG, PNG), and by the ending .tga of `name`, which stands
/// for the file in errors. Throws trace::DataError for a damaged image, another format, or more than 8192 x
/// 8192 texels.
Texture read_texture(std::span<const std::uint8_t> bytes, const std::string& name);

/// What is said of an image that is not read: "NAME: found FOUND, expected EXPECTED".
trace::DataError refused_image(const std::string& name, std::string_view found, std::string_view expected);

}  // namespace regather::imports
