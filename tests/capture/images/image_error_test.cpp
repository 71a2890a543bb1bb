// Errors of images small enough to work them out by hand.
#include "capture/images/image_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "trace/error.h"

namespace regather::capture {
namespace {

TEST(ImageErrors, TwoPixelsByHand) {
    const Image reference{2, 1, {{1, 2, 0}, {0.5f, 0.1f, 3}}}, image{2, 1, {{1.5f, 2, 0.1f}, {0.5f, 0, 1}}};
    const ImageErrors errors = image_errors(image, reference);
    // Differences: 0.5, 0, 0.1, 0, -0.1, -2.
    EXPECT_NEAR(errors.rmse, std::sqrt((0.25 + 0.01 + 0.01 + 4) / 6), 1e-7);
    EXPECT_NEAR(errors.rel_mse, (0.25 / 1.01 + 0.01 / 0.01 + 0.01 / 0.02 + 4 / 9.01) / 6, 1e-7);
    EXPECT_NEAR(errors.mape, (0.5 / 1.01 + 0.1 / 0.01 + 0.1 / 0.11 + 2 / 3.01) / 6, 1e-6);
    // The first pixel is the worse one: 0.2475 + 1 against 0.5 + 0.444.
    EXPECT_NEAR(errors.rel_mse_trimmed, (0.01 / 0.02 + 4 / 9.01) / 3, 1e-7);
}

TEST(ImageErrors, TrimmingDropsTheCeilingOfAThousandth) {
    Image reference{1001, 1, std::vector<trace::Vec3>(1001, {1, 1, 1})}, image = reference;
    image.pixels[3] = image.pixels[700] = {1e6f, 0, 0};
    EXPECT_EQ(image_errors(image, reference).rel_mse_trimmed, 0);
    image.pixels[9] = {2, 2, 2};
    EXPECT_NEAR(image_errors(image, reference).rel_mse_trimmed, 1 / 1.01 / 999, 1e-9);
}

TEST(ImageErrors, AnImageEqualsItself) {
    const Image image{1, 2, {{1, 2, 3}, {0, 0, 0}}};
    const ImageErrors errors = image_errors(image, image);
    EXPECT_EQ(errors.rmse, 0);
    EXPECT_EQ(errors.rel_mse, 0);
    EXPECT_EQ(errors.rel_mse_trimmed, 0);
    EXPECT_EQ(errors.mape, 0);
}

TEST(ImageErrors, WhatCannotBeComparedIsRefused) {
    const Image small{1, 1, {{1, 1, 1}}}, wide{2, 1, {{1, 1, 1}, {1, 1, 1}}}, tall{1, 2, wide.pixels};
    EXPECT_THROW(image_errors(small, wide), trace::DataError);
    EXPECT_THROW(image_errors(tall, wide), trace::DataError);
    EXPECT_THROW(image_errors({}, {}), trace::DataError);
    const Image nan{1, 1, {{1, std::numeric_limits<float>::quiet_NaN(), 1}}};
    EXPECT_THROW(image_errors(nan, small), trace::DataError);
    EXPECT_THROW(image_errors(small, nan), trace::DataError);
}

TEST(MeanRadiance, IsOverPixelsAndChannels) {
    EXPECT_DOUBLE_EQ(mean_radiance({2, 1, {{1, 2, 3}, {0, 0, 6}}}), 2);
    EXPECT_EQ(mean_radiance({}), 0);
}

}  // namespace
}  // namespace regather::capture
