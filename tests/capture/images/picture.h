// tests/capture/images/picture.h -- pictures read back, by the libraries' own readers.
#pragma once
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <png.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "capture/images/image.h"

namespace regather::capture {

/// One channel of an EXR, in row order.
inline std::vector<float> read_channel(const std::filesystem::path& path, const std::string& name) {
    Imf::InputFile file(path.c_str(), 0);
    const Imath::Box2i window = file.header().dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    const auto height = static_cast<std::size_t>(window.max.y - window.min.y + 1);
    if (!file.header().channels().findChannel(name)) throw std::runtime_error("no channel " + name);
    std::vector<float> values(width * height);
    Imf::FrameBuffer target;
    target.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                                   sizeof(float) * width));
    file.setFrameBuffer(target);
    file.readPixels(window.min.y, window.max.y);
    return values;
}

/// The channels R, G and B of an EXR.
inline Image read_exr(const std::filesystem::path& path) {
    const auto r = read_channel(path, "R"), g = read_channel(path, "G"), b = read_channel(path, "B");
    const Imath::Box2i window = Imf::InputFile(path.c_str(), 0).header().dataWindow();
    Image image{
        static_cast<std::uint32_t>(window.max.x + 1), static_cast<std::uint32_t>(window.max.y + 1), {}};
    for (std::size_t i = 0; i < r.size(); ++i) image.pixels.push_back({r[i], g[i], b[i]});
    return image;
}

struct Png {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

inline Png read_png(const std::filesystem::path& path) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&image, path.c_str()) == 0) throw std::runtime_error(image.message);
    image.format = PNG_FORMAT_RGB;
    Png png{image.width, image.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
    if (png_image_finish_read(&image, nullptr, png.rgb.data(), 0, nullptr) == 0)
        throw std::runtime_error(image.message);
    return png;
}

}  // namespace regather::capture
