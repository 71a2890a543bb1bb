// study/error_parts.h -- bias and variance of a renderer apart, from several images of one setting and a
// reference with noise of its own. With Y_m = X_m - R, the inner products <Y_m, Y_n> (means over pixels and
// channels) of two different images hold bias^2 and the reference's variance, those of an image with itself
// the variance, too: their differences estimate each without bias. The standard error of bias^2 comes from
// leaving one image out at a time (jackknife), so that noise that neighbouring pixels share, as photons make
// it, counts as what it is.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "capture/images/image.h"

namespace regather::study {

/// The reference: unbiased, with the variance of its mean.
struct Truth {
    capture::Image mean;
    std::vector<trace::Vec3> variance;  ///< Of `mean`, by pixel and channel [(W / (m^2 sr))^2].
    std::uint64_t samples = 0;          ///< A pixel.
};

/// Means over pixels and channels [(W / (m^2 sr))^2].
struct ErrorParts {
    double squared_error = 0;  ///< Of one image against the truth; the reference's variance is taken off.
    double reference_variance = 0;
    std::optional<double> variance, bias_squared;                ///< From two images on.
    std::optional<double> variance_stderr, bias_squared_stderr;  ///< From three images on.
};

/// Of the pixels where `mask` is not 0; an empty mask takes all. Images are as large as the truth; at least
/// one, and at least one pixel.
ErrorParts error_parts(std::span<const capture::Image> images, const Truth& truth,
                       std::span<const std::uint8_t> mask = {});

}  // namespace regather::study
