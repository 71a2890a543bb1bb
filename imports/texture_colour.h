// imports/texture_colour.h -- the mean colour of an image file: what is left of a texture in a renderer
// without textures.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "trace/vec.h"

namespace regather::imports {

/// Linear RGB in [0, 1]: each texel's sRGB value is decoded before the mean is taken; texels that an alpha
/// channel hides count as much as it shows. Throws trace::DataError as read_texture() (imports/texture.h)
/// does.
trace::Vec3 mean_colour(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace regather::imports
