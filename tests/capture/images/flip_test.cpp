// FLIP against values from elsewhere. For images of one colour the filters drop out and the value follows
// from the published formulas; the values of patterned images come from a separate program that sums over
// whole two-dimensional kernels. (The authors' own pictures and their means, 0.159691 and 0.283478, are not
// available to this test.)
#include "capture/images/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "trace/error.h"

namespace regather::capture {
namespace {

Image flat(trace::Vec3 colour, std::uint32_t width = 30, std::uint32_t height = 5) {
    return {width, height, std::vector<trace::Vec3>(std::size_t{width} * height, colour)};
}

/// 12 x 9 pixels of values in [0, 1] that differ everywhere.
Image pattern(int s) {
    Image image{12, 9, {}};
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 12; ++x) {
            trace::Vec3 pixel;
            for (int c = 0; c < 3; ++c)
                pixel[c] = static_cast<float>((x * 37 + y * 101 + c * 53 + s * 17 + x * y * s * 7) % 97) / 96;
            image.pixels.push_back(pixel);
        }
    return image;
}

Image bright(Image image) {
    for (trace::Vec3& pixel : image.pixels)
        for (int c = 0; c < 3; ++c) pixel[c] = std::exp(5 * pixel[c] - 3);
    return image;
}

TEST(LdrFlip, AnImageEqualsItself) {
    for (const float v : ldr_flip(pattern(1), pattern(1))) EXPECT_EQ(v, 0);
}

/// L* of a grey that has the luminance share y of white.
double lightness(double y) {
    return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

TEST(LdrFlip, GreysFollowFromTheirLightness) {
    // a* = b* = 0 for greys: the distance is that of L*, to the power 0.7; the largest one, green to blue, is
    // 41.2761 after the power, and the knee lies at 0.4 of it.
    const double most = 41.276098411857355, knee = 0.4 * most;
    for (const auto& [a, b] : {std::pair{0.2, 0.25}, {0.0, 0.01}, {0.5, 0.4}}) {
        const double powered = std::pow(std::abs(lightness(a) - lightness(b)), 0.7);
        ASSERT_LT(powered, knee);
        const auto va = static_cast<float>(a), vb = static_cast<float>(b);
        for (const float v : ldr_flip(flat({va, va, va}), flat({vb, vb, vb})))
            EXPECT_NEAR(v, 0.95 / knee * powered, 2e-6);
    }
    // Black and white: 100^0.7 = 25.1189 is beyond the knee.
    const double expected = 0.95 + 0.05 * (std::pow(100, 0.7) - knee) / (most - knee);
    for (const float v : ldr_flip(flat({}), flat({1, 1, 1}))) EXPECT_NEAR(v, expected, 2e-6);
}

TEST(LdrFlip, GreenToBlueIsTheMost) {
    for (const float v : ldr_flip(flat({0, 1, 0}), flat({0, 0, 1}))) EXPECT_NEAR(v, 1, 1e-6);
    for (const float v : ldr_flip(flat({1, 0, 0}), flat({0, 1, 0}))) EXPECT_NEAR(v, 0.986662275, 2e-6);
}

TEST(LdrFlip, IsWhatASlowSeparateProgramGives) {
    const auto map = ldr_flip(pattern(1), pattern(2));
    EXPECT_NEAR(mean_flip(map), 0.47265488, 1e-6);
    EXPECT_NEAR(map[0], 0.52291632, 2e-6);
    EXPECT_NEAR(map[5 * 12 + 7], 0.61935264, 2e-6);
    EXPECT_NEAR(*std::max_element(map.begin(), map.end()), 0.96894043, 2e-6);
}

TEST(LdrFlip, IsSymmetricAndWithinBounds) {
    const auto there = ldr_flip(pattern(1), pattern(3)), back = ldr_flip(pattern(3), pattern(1));
    EXPECT_EQ(there, back);
    for (const float v : there) {
        EXPECT_GE(v, 0);
        EXPECT_LE(v, 1);
    }
}

TEST(LdrFlip, ValuesOutsideTheGamutAreClamped) {
    EXPECT_EQ(ldr_flip(flat({-1, 0.5f, 7}), flat({0.2f, 0.2f, 0.2f})),
              ldr_flip(flat({0, 0.5f, 1}), flat({0.2f, 0.2f, 0.2f})));
}

TEST(LdrFlip, AnEdgeCountsMoreThanItsColour) {
    // A step of grey on the left half: next to it the feature term lifts what the colours alone would give.
    Image step = flat({0.3f, 0.3f, 0.3f}, 64, 16);
    for (std::size_t i = 0; i < step.pixels.size(); ++i)
        if (i % 64 < 32) step.pixels[i] = {0.35f, 0.35f, 0.35f};
    const auto map = ldr_flip(step, flat({0.3f, 0.3f, 0.3f}, 64, 16));
    EXPECT_GT(map[8 * 64 + 31], map[8 * 64 + 4]);
    EXPECT_NEAR(map[8 * 64 + 60], 0, 1e-6);
}

TEST(HdrFlip, ExposuresTakeTheBrightestAndTheMedianToTheSameTone) {
    const Exposures found = flip_exposures(bright(pattern(2)));
    EXPECT_NEAR(found.start, -1.35977208, 1e-5);
    EXPECT_NEAR(found.stop, 0.92022999, 1e-5);
    EXPECT_EQ(found.count, 3u);
    // One colour: start and stop agree, and there are two all the same.
    const Exposures flat_ones = flip_exposures(flat({2, 2, 2}));
    EXPECT_EQ(flat_ones.start, flat_ones.stop);
    EXPECT_EQ(flat_ones.count, 2u);
    EXPECT_EQ(flip_exposures(flat({})).count, 1u);
    // A median of 0: the least luminance above 0 stands in for it.
    Image sparse = flat({}, 5, 1);
    sparse.pixels[1] = {8, 8, 8};
    sparse.pixels[2] = {1, 1, 1};
    EXPECT_NEAR(flip_exposures(sparse).stop - flip_exposures(sparse).start, 3, 1e-6);
}

TEST(HdrFlip, IsWhatASlowSeparateProgramGives) {
    const auto map = hdr_flip(bright(pattern(1)), bright(pattern(2)));
    EXPECT_NEAR(mean_flip(map), 0.55734440, 2e-6);
    EXPECT_NEAR(map[0], 0.58873612, 3e-6);
    EXPECT_NEAR(map[5 * 12 + 7], 0.78290652, 3e-6);
}

TEST(HdrFlip, DoesNotDependOnTheUnitOfRadiance) {
    const Image a = bright(pattern(1)), b = bright(pattern(2));
    Image a8 = a, b8 = b;
    for (trace::Vec3& p : a8.pixels) p = p * 1024;
    for (trace::Vec3& p : b8.pixels) p = p * 1024;
    const auto one = hdr_flip(a, b), other = hdr_flip(a8, b8);
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], other[i], 1e-6);
}

TEST(HdrFlip, BlackImagesAreEqual) {
    for (const float v : hdr_flip(flat({}), flat({}))) EXPECT_EQ(v, 0);
    EXPECT_THROW(hdr_flip(flat({}, 2, 2), flat({}, 2, 3)), trace::DataError);
}

}  // namespace
}  // namespace regather::capture
