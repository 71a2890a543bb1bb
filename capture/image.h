// capture/image.h -- images in and out, through OpenImageIO: linear radiance as EXR, a view of it as PNG.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "trace/vec.h"

namespace regather::capture {

/// Row order, first row at the top; linear RGB [W / (m^2 sr)].
struct Image {
    std::uint32_t width = 0, height = 0;
    std::vector<trace::Vec3> pixels;
};

/// 32-bit float EXR; written beside and renamed, so that no half image has this name. Throws
/// std::runtime_error.
void write_exr(const std::filesystem::path& path, const Image& image);

/// 8-bit sRGB view: radiance times `exposure` through the curve 1 - exp(-x).
void write_png(const std::filesystem::path& path, const Image& image, float exposure);

/// Exposure that takes the mean luminance of the image to a middle tone (0.25 before the sRGB curve); 1 for a black image.
float middle_exposure(const Image& image);

/// Throws trace::DataError when the file is no RGB image.
Image read_image(const std::filesystem::path& path);

}  // namespace regather::capture
