#include "capture/image.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "trace/error.h"

namespace regather::capture {
namespace {

namespace fs = std::filesystem;

template <class Value>
void write(const fs::path& path, std::uint32_t width, std::uint32_t height,
           const std::vector<std::string>& names, const std::vector<Value>& values, OIIO::TypeDesc type,
           const char* color_space) {
    fs::path partial = path.parent_path() / fmt::format("partial-{}", path.filename().string());
    const auto fail = [&](const std::string& what) {
        fs::remove(partial);
        throw std::runtime_error(fmt::format("{}: cannot write: {}", path.string(), what));
    };
    const auto output = OIIO::ImageOutput::create(path.string());
    if (!output) fail(OIIO::geterror());
    OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), static_cast<int>(names.size()),
                         type);
    spec.channelnames = names;
    spec.attribute("oiio:ColorSpace", color_space);
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "");  // else OpenImageIO writes the clock into the file
    if (!output->open(partial.string(), spec)) fail(output->geterror());
    if (!output->write_image(type, values.data())) fail(output->geterror());
    if (!output->close()) fail(output->geterror());
    std::error_code error;
    fs::rename(partial, path, error);
    if (error) fail(error.message());
}

float to_srgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float toned(float x, Tone tone) {
    switch (tone) {
        case Tone::exponential:
            return 1 - std::exp(-x);
        case Tone::linear:
            return std::min(x, 1.0f);
        case Tone::aces:
            return std::min(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 1.0f);
    }
    return 0;
}

const std::vector<std::string> rgb{"R", "G", "B"};

}  // namespace

void write_exr(const fs::path& path, const Image& image) {
    write_exr(path, image.width, image.height, channels_of(image, ""));
}

void write_exr(const fs::path& path, std::uint32_t width, std::uint32_t height,
               std::span<const Channel> channels) {
    std::vector<std::string> names;
    for (const Channel& channel : channels) names.push_back(channel.name);
    std::vector<float> values;
    values.reserve(std::size_t{width} * height * channels.size());
    for (std::size_t i = 0; i < std::size_t{width} * height; ++i)
        for (const Channel& channel : channels) values.push_back(channel.values[i]);
    write(path, width, height, names, values, OIIO::TypeDesc::FLOAT, "Linear");
}

std::vector<Channel> channels_of(const Image& image, const std::string& layer) {
    std::vector<Channel> channels;
    for (int c = 0; c < 3; ++c) {
        Channel& channel = channels.emplace_back(Channel{layer.empty() ? rgb[c] : layer + "." + rgb[c], {}});
        channel.values.reserve(image.pixels.size());
        for (const trace::Vec3 p : image.pixels) channel.values.push_back(p[c]);
    }
    return channels;
}

void write_png(const fs::path& path, const Image& image, float exposure, Tone tone) {
    std::vector<std::uint8_t> values;
    values.reserve(3 * image.pixels.size());
    for (trace::Vec3 p : image.pixels)
        for (int c = 0; c < 3; ++c) {
            const float shown = to_srgb(toned(std::max(0.0f, p[c] * exposure), tone));
            values.push_back(static_cast<std::uint8_t>(std::clamp(shown * 255 + 0.5f, 0.0f, 255.0f)));
        }
    write_png(path, image.width, image.height, values);
}

void write_png(const fs::path& path, std::uint32_t width, std::uint32_t height,
               std::vector<std::uint8_t> values) {
    write(path, width, height, rgb, values, OIIO::TypeDesc::UINT8, "sRGB");
}

float middle_exposure(const Image& image) {
    double sum = 0;
    for (trace::Vec3 p : image.pixels) sum += luminance(p);
    const double mean = image.pixels.empty() ? 0 : sum / static_cast<double>(image.pixels.size());
    return mean > 0 ? static_cast<float>(0.2876820724517809 / mean) : 1.0f;  // 1 - exp(-x) = 0.25
}

Image read_image(const fs::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input) throw trace::DataError(fmt::format("{}: {}", path.string(), OIIO::geterror()));
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.nchannels < 3)
        throw trace::DataError(
            fmt::format("{}: found {} channels, expected 3", path.string(), spec.nchannels));
    Image image{static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height), {}};
    image.pixels.resize(std::size_t{image.width} * image.height);
    if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, image.pixels.data()))
        throw trace::DataError(fmt::format("{}: {}", path.string(), input->geterror()));
    return image;
}

}  // namespace regather::capture
