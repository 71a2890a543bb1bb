#include "capture/images/png_bytes.h"

#include <fmt/format.h>
#include <png.h>

#include <stdexcept>

namespace regather::capture {

std::string png_bytes(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgb) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = PNG_FORMAT_RGB;
    std::string bytes;
    // Once for the size and once for the bytes: a picture is small beside the rendering.
    png_alloc_size_t size = 0;
    bool done = png_image_write_to_memory(&image, nullptr, &size, 0, rgb.data(), 0, nullptr) != 0;
    if (done) {
        bytes.resize(size);
        done = png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) != 0;
    }
    if (!done)
        throw std::runtime_error(fmt::format("a picture of {} x {} pixels cannot be a PNG", width, height));
    bytes.resize(size);
    return bytes;
}

}  // namespace regather::capture
