// Bias and variance of images whose bias and variance are known.
#include "study/error_parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/sampler.h"

namespace regather::study {
namespace {

using capture::Image;

Image flat(float value, std::uint32_t pixels = 4) {
    return {pixels, 1, std::vector<trace::Vec3>(pixels, {value, value, value})};
}

TEST(ErrorParts, TwoImagesByHand) {
    // Errors 3 and 1 everywhere: mean squared error 5, product 3, variance (3 - 1)^2 / 2 = 2; the reference's
    // variance 0.5 is in the products, not in the variance.
    const Truth truth{flat(1), std::vector<trace::Vec3>(4, {0.5f, 0.5f, 0.5f}), 1};
    const std::vector<Image> images{flat(4), flat(2)};
    const ErrorParts found = error_parts(images, truth);
    EXPECT_DOUBLE_EQ(found.squared_error, 4.5);
    EXPECT_DOUBLE_EQ(*found.variance, 2);
    EXPECT_DOUBLE_EQ(*found.bias_squared, 2.5);
    EXPECT_DOUBLE_EQ(found.reference_variance, 0.5);
    EXPECT_FALSE(found.bias_squared_stderr);
}

TEST(ErrorParts, TheJackknifeByHand) {
    // Errors 1, 2, 3: pairs without the first 6, without the second 3, without the third 2; their mean is 11
    // / 3.
    const Truth truth{flat(0), {}, 1};
    const std::vector<Image> images{flat(1), flat(2), flat(3)};
    const ErrorParts found = error_parts(images, truth);
    EXPECT_NEAR(*found.bias_squared, 11.0 / 3, 1e-12);
    EXPECT_NEAR(*found.variance, 1, 1e-12);
    const double squares = std::pow(6 - 11.0 / 3, 2) + std::pow(3 - 11.0 / 3, 2) + std::pow(2 - 11.0 / 3, 2);
    EXPECT_NEAR(*found.bias_squared_stderr, std::sqrt(squares * 2 / 3), 1e-12);
    // Variances of two: of 2 and 3 it is 1/2, of 1 and 3 it is 2, of 1 and 2 it is 1/2; their mean is 1.
    EXPECT_NEAR(*found.variance_stderr, std::sqrt((0.25 + 1 + 0.25) * 2 / 3), 1e-12);
}

TEST(ErrorParts, OneImageHasNeither) {
    const std::vector<Image> images{flat(3)};
    const ErrorParts found = error_parts(images, {flat(1), {}, 1});
    EXPECT_DOUBLE_EQ(found.squared_error, 4);
    EXPECT_FALSE(found.variance);
    EXPECT_FALSE(found.bias_squared);
}

TEST(ErrorParts, OnlyMaskedPixelsCount) {
    Image image = flat(0, 2);
    image.pixels[1] = {100, 100, 100};
    const std::vector<Image> images{image, image};
    const std::vector<std::uint8_t> mask{1, 0};
    Truth truth{flat(2, 2), {{1, 1, 1}, {50, 50, 50}}, 1};
    const ErrorParts found = error_parts(images, truth, mask);
    EXPECT_DOUBLE_EQ(found.squared_error, 3);
    EXPECT_DOUBLE_EQ(*found.bias_squared, 3);
    EXPECT_DOUBLE_EQ(*found.variance, 0);
}

/// Uniform noise of a known variance on images and reference.
TEST(ErrorParts, EstimatesAreWithoutBiasUnderNoise) {
    constexpr std::uint32_t pixels = 64, runs = 400, seeds = 4;
    const double noise = 0.6, reference_noise = 0.3, bias = 0.05;  // widths of uniform distributions
    double variance = 0, bias_squared = 0, squared_error = 0, stderr_squared = 0, spread = 0;
    for (std::uint32_t run = 0; run < runs; ++run) {
        capture::Sampler sampler(run + 1, capture::Stream::eye, 0);
        const auto noisy = [&](double width, double shift) {
            Image image = flat(0, pixels);
            for (trace::Vec3& pixel : image.pixels)
                for (int c = 0; c < 3; ++c)
                    pixel[c] =
                        static_cast<float>(shift + width * (static_cast<double>(sampler.uniform()) - 0.5));
            return image;
        };
        const auto v = static_cast<float>(reference_noise * reference_noise / 12);
        const Truth truth{noisy(reference_noise, 0), std::vector<trace::Vec3>(pixels, {v, v, v}), 1};
        std::vector<Image> images;
        for (std::uint32_t s = 0; s < seeds; ++s) images.push_back(noisy(noise, bias));
        const ErrorParts found = error_parts(images, truth);
        variance += *found.variance / runs;
        bias_squared += *found.bias_squared / runs;
        squared_error += found.squared_error / runs;
        stderr_squared += *found.bias_squared_stderr * *found.bias_squared_stderr / runs;
        spread += std::pow(*found.bias_squared - bias * bias, 2) / runs;
    }
    const double own = noise * noise / 12;
    EXPECT_NEAR(variance, own, 0.01 * own);
    EXPECT_NEAR(bias_squared, bias * bias, 4 * std::sqrt(spread / runs));
    EXPECT_NEAR(squared_error, own + bias * bias, 0.02 * own);
    // The jackknife tells the spread between runs within what four images allow.
    EXPECT_GT(stderr_squared, 0.5 * spread);
    EXPECT_LT(stderr_squared, 2.5 * spread);
}

}  // namespace
}  // namespace regather::study
