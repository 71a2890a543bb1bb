// The strip: signed errors, their colours, and what stands where.
#include "capture/images/image_strip.h"

#include <gtest/gtest.h>

#include "tests/capture/images/picture.h"
#include "tests/scratch.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

TEST(SignedError, IsRelativeToTheReference) {
    const Image reference{4, 1, {{2, 2, 2}, {1, 1, 1}, {0, 0, 0}, {1, 1, 1}}};
    const Image image{4, 1, {{1, 1, 1}, {1.5f, 1.5f, 1.5f}, {0.02f, 0.02f, 0.02f}, {1, 1, 1}}};
    const auto errors = signed_error(image, reference);
    EXPECT_NEAR(errors[0], -0.5, 1e-6);
    EXPECT_NEAR(errors[1], 0.5, 1e-6);
    EXPECT_NEAR(errors[2], 0.02 / 0.01, 1e-5);  // black: against a hundredth of the mean luminance, 1
    EXPECT_EQ(errors[3], 0);
}

TEST(ErrorRange, IsRoundAndHoldsNineteenOfTwenty) {
    std::vector<float> errors(100, 0.03f);
    EXPECT_FLOAT_EQ(error_range(errors), 0.05f);
    for (int i = 0; i < 6; ++i) errors[static_cast<std::size_t>(i)] = -0.7f;
    EXPECT_FLOAT_EQ(error_range(errors), 1.0f);
    errors[0] = 0.03f;
    EXPECT_FLOAT_EQ(error_range(errors), 0.05f);
    EXPECT_FLOAT_EQ(error_range({0.2f}), 0.2f);
    EXPECT_FLOAT_EQ(error_range({0, 0}), 0.01f);
}

TEST(FalseColour, RunsFromBlueOverWhiteToRed) {
    EXPECT_EQ(false_colour(0, 0.5f), (Rgb{255, 255, 255}));
    EXPECT_EQ(false_colour(-9, 0.5f), (Rgb{33, 102, 172}));
    EXPECT_EQ(false_colour(0.5f, 0.5f), (Rgb{178, 24, 43}));
    EXPECT_EQ(false_colour(0.25f, 0.5f), (Rgb{217, 140, 149}));
}

TEST(ImageStrip, ShowsResultReferenceErrorAndBar) {
    // Two pixels: a panel has 256 x 128 pixels of 128 x 128 squares, 10 around and 32 + 0 above for the
    // titles.
    const Image reference{2, 1, {{1, 1, 1}, {1, 1, 1}}}, image{2, 1, {{1, 1, 1}, {0.5f, 0.5f, 0.5f}}};
    const Picture strip = image_strip(image, reference);
    const auto at = [&](std::uint32_t x, std::uint32_t y) {
        return strip.pixels[std::size_t{y} * strip.width + x];
    };
    const std::uint32_t middle = 32 + 64;
    EXPECT_EQ(at(10 + 5, middle), at(276 + 5, middle));  // as bright as the reference
    EXPECT_LT(at(10 + 200, middle)[0], at(276 + 200, middle)[0]);
    EXPECT_EQ(at(542 + 5, middle), (Rgb{255, 255, 255}));   // no error
    EXPECT_EQ(at(542 + 200, middle), (Rgb{33, 102, 172}));  // half: the range is 50 %
    EXPECT_NEAR(at(808 + 8, 32)[0], 178, 2);                // the bar: red on top,
    EXPECT_GE(at(808 + 8, middle)[1], 250);                 // white in the middle,
    EXPECT_NEAR(at(808 + 8, 32 + 127)[2], 172, 2);          // blue below
    EXPECT_EQ(at(3, 3), (Rgb{255, 255, 255}));
    bool written = false;
    for (std::uint32_t x = 10; x < 100; ++x) written |= at(x, 15)[0] < 100;
    EXPECT_TRUE(written);
    EXPECT_THROW(image_strip(image, {1, 1, {{1, 1, 1}}}), trace::DataError);
}

TEST(ImageStrip, IsWrittenWhole) {
    const Scratch scratch;
    const Image image{1, 1, {{1, 1, 1}}};
    const Picture strip = image_strip(image, image);
    write_strip(scratch / "strip.png", strip);
    const Png back = read_png(scratch / "strip.png");
    EXPECT_EQ(back.width, strip.width);
    EXPECT_EQ(back.height, strip.height);
    EXPECT_EQ(back.rgb.size(), 3 * strip.pixels.size());
    EXPECT_EQ(back.rgb[3 * 40 + 1], strip.pixels[40][1]);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.path()), {}), 1);
}

}  // namespace
}  // namespace regather::capture
