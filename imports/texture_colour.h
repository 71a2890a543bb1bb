// imports/texture_colour.h -- the mean colour of an image file, read by OpenImageIO: what is left of a
// texture in a renderer without textures.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "trace/vec.h"

namespace regather::imports {

/// Linear RGB in [0, 1]: each texel's sRGB value is decoded before the mean is taken; texels that an alpha
/// channel hides count as much as it shows. `name` (with its ending, .jpg, .tga or .png) stands for the file
/// in errors. Throws trace::DataError for a damaged image, another format, or more than 8192 x 8192 texels.
trace::Vec3 mean_colour(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace regather::imports
