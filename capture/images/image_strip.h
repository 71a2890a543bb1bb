// capture/images/image_strip.h -- an image, its reference and its error in false colour side by side, with a
// colour bar: one PNG.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "capture/images/image.h"

namespace regather::capture {

struct StripText {
    std::string image = "result";  ///< Over the image.
    std::string reference = "reference";
};

/// 8-bit sRGB pixels in row order.
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::array<std::uint8_t, 3>> pixels;
};

/// Signed error of the luminance by pixel, relative to the reference's luminance; where that is below a
/// hundredth of its mean over the image, relative to this hundredth. Negative: the image is too dark.
std::vector<float> signed_error(const Image& image, const Image& reference);

/// Round bound (1, 2 or 5 times a power of ten) of 95 % of the errors' sizes.
float error_range(const std::vector<float>& errors);

/// Blue at or below -range, white at 0, red at or above +range.
std::array<std::uint8_t, 3> false_colour(float error, float range);

/// Image and reference under the reference's middle exposure as write_png shows them, each pixel enlarged to
/// a square until a panel is at least 256 pixels wide; the error in false colour; its colour bar from -range
/// to +range in percent. trace::DataError as image_errors() throws it.
Picture image_strip(const Image& image, const Image& reference, const StripText& text = {});

/// As write_png().
void write_strip(const std::filesystem::path& path, const Picture& picture);

}  // namespace regather::capture
