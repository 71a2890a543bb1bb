#include "capture/images/image.h"

#include <algorithm>
#include <cmath>

#include "capture/images/png_bytes.h"
#include "trace/file.h"

namespace regather::capture {
namespace {

namespace fs = std::filesystem;

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

constexpr std::array rgb{"R", "G", "B"};

}  // namespace

void write_exr(const fs::path& path, const Image& image) {
    write_exr(path, image.width, image.height, channels_of(image, ""));
}

void write_exr(const fs::path& path, std::uint32_t width, std::uint32_t height,
               std::span<const Channel> channels) {
    trace::write_whole(path, exr_bytes(width, height, channels));
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

std::array<std::uint8_t, 3> on_screen(trace::Vec3 radiance, float exposure, Tone tone) {
    const auto byte = [&](float value) {
        const float shown = to_srgb(toned(std::max(0.0f, value * exposure), tone));
        return static_cast<std::uint8_t>(std::clamp(shown * 255 + 0.5f, 0.0f, 255.0f));
    };
    return {byte(radiance.x), byte(radiance.y), byte(radiance.z)};
}

void write_png(const fs::path& path, const Image& image, float exposure, Tone tone) {
    std::vector<std::uint8_t> values;
    values.reserve(3 * image.pixels.size());
    for (const trace::Vec3 p : image.pixels) {
        const auto shown = on_screen(p, exposure, tone);
        values.insert(values.end(), shown.begin(), shown.end());
    }
    write_png(path, image.width, image.height, values);
}

void write_png(const fs::path& path, std::uint32_t width, std::uint32_t height,
               std::span<const std::uint8_t> values) {
    trace::write_whole(path, png_bytes(width, height, values));
}

float middle_exposure(const Image& image) {
    double sum = 0;
    for (trace::Vec3 p : image.pixels) sum += luminance(p);
    const double mean = image.pixels.empty() ? 0 : sum / static_cast<double>(image.pixels.size());
    return mean > 0 ? static_cast<float>(0.2876820724517809 / mean) : 1.0f;  // 1 - exp(-x) = 0.25
}

}  // namespace regather::capture
