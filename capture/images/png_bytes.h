// capture/images/png_bytes.h -- 8-bit pictures as the bytes of a PNG file.
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace regather::capture {

/// `rgb`: sRGB, three bytes a pixel, rows from the top. Throws std::runtime_error when there is no pixel.
std::string png_bytes(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgb);

}  // namespace regather::capture
