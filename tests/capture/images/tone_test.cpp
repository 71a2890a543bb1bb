// The bytes of pictures, against the formula of sRGB (IEC 61966-2-1) in double.
#include "capture/images/image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/capture/images/picture.h"
#include "tests/scratch.h"

namespace regather::capture {
namespace {

/// The linear value whose sRGB value is `byte` / 255.
double linear_of(double byte) {
    const double s = byte / 255;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

/// Of a picture that was written and read back.
std::vector<int> bytes_of(const Image& image, float exposure, Tone tone) {
    const Scratch scratch;
    write_png(scratch / "image.png", image, exposure, tone);
    const std::vector<std::uint8_t> rgb = read_png(scratch / "image.png").rgb;
    return {rgb.begin(), rgb.end()};
}

TEST(Tone, AValueIsTheNearestByte) {
    Image image{0, 1, {}};
    std::vector<int> expected;
    for (const int byte : {0, 3, 10, 11, 77, 128, 200, 253})
        for (const double part : {0.3, 0.45, 0.55}) {
            const auto of = [&](double at) { return static_cast<float>(linear_of(at)); };
            image.pixels.push_back({of(byte + part), of(byte + part + 1), of(byte + part)});
            const int nearest = part < 0.5 ? byte : byte + 1;
            for (const int channel : {nearest, nearest + 1, nearest}) expected.push_back(channel);
        }
    image.width = static_cast<std::uint32_t>(image.pixels.size());
    EXPECT_EQ(bytes_of(image, 1, Tone::linear), expected);
}

TEST(Tone, TonesAreTheirCurves) {
    const Image image{3, 1, {{0.2f, 0.02f, 7}, {1, 0, -1}, {0.001f, 100, 0.5f}}};
    const double exposure = 1.5;
    for (const Tone tone : {Tone::exponential, Tone::linear, Tone::aces}) {
        const std::vector<int> bytes = bytes_of(image, static_cast<float>(exposure), tone);
        for (std::size_t i = 0; i < 9; ++i) {
            const double x =
                std::max(0.0, exposure * static_cast<double>(image.pixels[i / 3][static_cast<int>(i % 3)]));
            const double aces = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
            const double shown = std::min(1.0, tone == Tone::exponential ? 1 - std::exp(-x)
                                               : tone == Tone::linear    ? x
                                                                         : aces);
            const double srgb = shown <= 0.0031308 ? 12.92 * shown : 1.055 * std::pow(shown, 1 / 2.4) - 0.055;
            EXPECT_NEAR(bytes[i], 255 * srgb, 0.501)
                << i << " " << tone_names[static_cast<std::size_t>(tone)];
        }
    }
}

TEST(Tone, FirstRowsAndColumnsComeFirst) {
    const Image image{2, 3, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}}};
    const std::vector<int> bytes = bytes_of(image, 1, Tone::linear);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        EXPECT_EQ(bytes[i], image.pixels[i / 3][static_cast<int>(i % 3)] > 0 ? 255 : 0) << i;
}

TEST(Luminance, IsThatOfTheSRgbPrimaries) {
    EXPECT_DOUBLE_EQ(luminance(1, 10, 100), 0.2126 + 7.152 + 7.22);
    // The mean luminance 2 is shown as 1 - exp(-2 x) = 0.25.
    const Image image{2, 1, {{1, 1, 1}, {3, 3, 3}}};
    EXPECT_NEAR(1 - std::exp(-2 * static_cast<double>(middle_exposure(image))), 0.25, 1e-6);
    EXPECT_EQ(middle_exposure({1, 1, {{0, 0, 0}}}), 1);
}

}  // namespace
}  // namespace regather::capture
