#include "capture/images/image_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "trace/error.h"

namespace regather::capture {
namespace {

void check_finite(const Image& image, const char* what) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (!trace::is_finite(image.pixels[i]))
            throw trace::DataError(fmt::format("{}: pixel {}, {} is not finite, expected radiance", what,
                                               i % image.width, i / image.width));
}

}  // namespace

void check_comparable(const Image& image, const Image& reference, const char* what) {
    if (image.width != reference.width || image.height != reference.height)
        throw trace::DataError(fmt::format("{}: found {} x {} pixels, expected the reference's {} x {}", what,
                                           image.width, image.height, reference.width, reference.height));
    if (reference.pixels.empty() || image.pixels.size() != reference.pixels.size())
        throw trace::DataError(
            fmt::format("{}: found {} pixels beside {} of the reference, expected as many, at least one",
                        what, image.pixels.size(), reference.pixels.size()));
    check_finite(image, what);
    check_finite(reference, "reference");
}

ImageErrors image_errors(const Image& image, const Image& reference) {
    check_comparable(image, reference, "image");
    const std::size_t pixels = reference.pixels.size();
    std::vector<double> relative(pixels);
    double squares = 0, absolute = 0, sum = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        for (int c = 0; c < 3; ++c) {
            const double r = static_cast<double>(reference.pixels[i][c]);
            const double d = static_cast<double>(image.pixels[i][c]) - r;
            squares += d * d;
            relative[i] += d * d / (r * r + relative_epsilon);
            absolute += std::abs(d) / (std::abs(r) + relative_epsilon);
        }
        sum += relative[i];
    }
    const double values = 3 * static_cast<double>(pixels);
    ImageErrors errors;
    errors.rmse = std::sqrt(squares / values);
    errors.rel_mse = sum / values;
    errors.mape = absolute / values;
    const std::size_t dropped = (pixels + trimmed_share - 1) / trimmed_share;
    if (dropped == pixels) return errors;  // a single pixel: nothing would be left
    std::sort(relative.begin(), relative.end());
    double kept = 0;
    for (std::size_t i = 0; i + dropped < pixels; ++i) kept += relative[i];
    errors.rel_mse_trimmed = kept / (3 * static_cast<double>(pixels - dropped));
    return errors;
}

double mean_radiance(const Image& image) {
    double sum = 0;
    for (const trace::Vec3 pixel : image.pixels)
        for (int c = 0; c < 3; ++c) sum += static_cast<double>(pixel[c]);
    return image.pixels.empty() ? 0 : sum / (3 * static_cast<double>(image.pixels.size()));
}

}  // namespace regather::capture
