// capture/images/image.h -- images as files: linear radiance as EXR, a view of it as PNG. A file is whole or
// absent: disk full, or no permission, is a std::runtime_error that names it.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "capture/images/exr_bytes.h"
#include "trace/vec.h"

namespace regather::capture {

/// Row order, first row at the top; linear RGB [W / (m^2 sr)].
struct Image {
    std::uint32_t width = 0, height = 0;
    std::vector<trace::Vec3> pixels;
};

/// Of linear RGB with the primaries of Rec. 709 and sRGB.
inline double luminance(double red, double green, double blue) {
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}
inline double luminance(trace::Vec3 rgb) {
    return luminance(rgb.x, rgb.y, rgb.z);
}

/// 32-bit float EXR.
void write_exr(const std::filesystem::path& path, const Image& image);
/// The same for any channels ("direct.R", "variance.Y"); all have `width` x `height` values.
void write_exr(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
               std::span<const Channel> channels);
/// An image as three channels; `layer` is empty for the picture itself.
std::vector<Channel> channels_of(const Image& image, const std::string& layer);

/// The curve between exposed radiance x and the screen, before the sRGB curve: 1 - exp(-x), min(x, 1), or the
/// fit of the ACES filmic curve by Narkowicz ("ACES Filmic Tone Mapping Curve", 2015).
enum class Tone : std::uint8_t { exponential, linear, aces };
inline constexpr std::array<const char*, 3> tone_names{"exponential", "linear", "aces"};

/// 8-bit sRGB of radiance times `exposure`.
std::array<std::uint8_t, 3> on_screen(trace::Vec3 radiance, float exposure, Tone tone = Tone::exponential);

/// The image on_screen().
void write_png(const std::filesystem::path& path, const Image& image, float exposure,
               Tone tone = Tone::exponential);

/// 8-bit sRGB pixels, three bytes each.
void write_png(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
               std::span<const std::uint8_t> rgb);

/// Exposure that takes the mean luminance of the image to a middle tone (0.25 before the sRGB curve); 1 for a
/// black image.
float middle_exposure(const Image& image);

}  // namespace regather::capture
