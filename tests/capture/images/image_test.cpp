// Pictures as files: every value comes back, and nothing but whole files.
#include "capture/images/image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "capture/images/lettering.h"
#include "tests/capture/images/picture.h"
#include "tests/scratch.h"
#include "trace/file.h"

namespace regather::capture {
namespace {

// Three columns and two rows, all values different, and some that a conversion to half precision would lose.
Image colours() {
    return {
        3,
        2,
        {{1.1f, 2.2f, 3.3f}, {1e-30f, 4.4f, 5.5f}, {0, -1, 1e30f}, {7, 8, 9}, {0.1f, 0.2f, 0.3f}, {6, 5, 4}}};
}

TEST(Exr, HoldsEveryValueBitForBit) {
    const Scratch scratch;
    write_exr(scratch / "a.exr", colours());
    const Image back = read_exr(scratch / "a.exr");
    EXPECT_EQ(back.width, 3u);
    EXPECT_EQ(back.height, 2u);
    EXPECT_EQ(back.pixels, colours().pixels);
}

TEST(Exr, HoldsLayersByName) {
    const Scratch scratch;
    std::vector<Channel> channels = channels_of(colours(), "");
    for (Channel& channel : channels_of(colours(), "direct")) {
        for (float& value : channel.values) value *= 2;
        channels.push_back(channel);
    }
    channels.push_back({"variance.Y", {1, 2, 3, 4, 5, std::numeric_limits<float>::infinity()}});
    write_exr(scratch / "layers.exr", 3, 2, channels);
    EXPECT_EQ(read_exr(scratch / "layers.exr").pixels, colours().pixels);
    EXPECT_EQ(read_channel(scratch / "layers.exr", "direct.G"),
              (std::vector<float>{2 * 2.2f, 2 * 4.4f, -2, 16, 2 * 0.2f, 10}));
    EXPECT_EQ(read_channel(scratch / "layers.exr", "variance.Y"),
              (std::vector<float>{1, 2, 3, 4, 5, std::numeric_limits<float>::infinity()}));
}

TEST(Png, HoldsThePixelsGiven) {
    const Scratch scratch;
    const std::vector<std::uint8_t> rgb{0,  1,  2,  253, 254, 255, 10,  20,  30,
                                        40, 50, 60, 70,  80,  90,  128, 127, 126};
    write_png(scratch / "a.png", 3, 2, rgb);
    const Png back = read_png(scratch / "a.png");
    EXPECT_EQ(back.width, 3u);
    EXPECT_EQ(back.height, 2u);
    EXPECT_EQ(back.rgb, rgb);
}

// The sRGB curve of IEC 61966-2-1, by hand: 0.5 is 187.52 of 255, 0.001 is 3.29, 0.2140 is 127.46, 0.2159 is
// 127.98.
TEST(Png, ShowsLinearValuesByTheSrgbCurveRounded) {
    const Scratch scratch;
    write_png(scratch / "a.png",
              {4, 1, {{0.5f, 0.001f, 2}, {0.25f, 0.0005f, -1}, {0.1070f, 0.10795f, 0}, {0, 0, 0}}}, 2,
              Tone::linear);
    EXPECT_EQ(read_png(scratch / "a.png").rgb,
              (std::vector<std::uint8_t>{255, 7, 255, 188, 3, 0, 127, 128, 0, 0, 0, 0}));
}

TEST(Image, TheSamePictureGivesTheSameBytes) {
    const Scratch scratch;
    write_exr(scratch / "a.exr", colours());
    write_exr(scratch / "b.exr", colours());
    EXPECT_EQ(trace::read_file(scratch / "a.exr"), trace::read_file(scratch / "b.exr"));
}

TEST(Image, WhatCannotBeWrittenLeavesNothing) {
    const Scratch scratch;
    std::filesystem::create_directories(scratch / "a.exr");
    std::filesystem::create_directories(scratch / "a.png");
    EXPECT_THROW(write_exr(scratch / "a.exr", colours()), std::runtime_error);
    EXPECT_THROW(write_png(scratch / "a.png", colours(), 1), std::runtime_error);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.path()), {}), 2);
}

TEST(Lettering, IsAsWideAsItsLetters) {
    const Lettering one = lettering("W", 20, 1000), three = lettering("WWW", 20, 1000);
    // DejaVu Sans: W advances by 2025 of 2048 units an em; ascent 1901, descent 483.
    EXPECT_EQ(one.width, 20u);
    EXPECT_EQ(three.width, 60u);
    EXPECT_EQ(one.height, 19u + 5u);
    EXPECT_EQ(one.ink.size(), std::size_t{one.width} * one.height);
    EXPECT_EQ(lettering("", 20, 1000).width, 0u);
}

TEST(Lettering, StandsUprightAndFromLeftToRight) {
    const Lettering line = lettering("L_", 20, 1000);
    const auto ink = [&](std::uint32_t left, std::uint32_t right, std::uint32_t top, std::uint32_t bottom) {
        unsigned sum = 0;
        for (std::uint32_t y = top; y < bottom; ++y)
            for (std::uint32_t x = left; x < right; ++x) sum += line.ink[std::size_t{y} * line.width + x];
        return sum;
    };
    const std::uint32_t letter = 11;                    // L advances by 1141 of 2048 units: 11.1 pixels
    EXPECT_GT(ink(0, letter / 2, 4, 12), 1000u);        // the stem, on the left
    EXPECT_EQ(ink(letter / 2, letter, 4, 12), 0u);      // nothing to its right
    EXPECT_GT(ink(letter / 2, letter, 16, 20), 500u);   // the foot
    EXPECT_EQ(ink(letter + 1, line.width, 0, 19), 0u);  // the underscore lies below the line of writing
    EXPECT_GT(ink(letter, line.width, 19, 24), 500u);
}

TEST(Lettering, LeavesOutWhatWouldPassTheWidthAndWhatIsNoText) {
    EXPECT_EQ(lettering("WWW", 20, 59).width, 40u);
    EXPECT_EQ(lettering("WWW", 20, 60).width, 60u);
    EXPECT_EQ(lettering("W\xff\nW", 20, 1000).ink, lettering("WW", 20, 1000).ink);
    // One letter of two bytes, as wide as its Latin model.
    EXPECT_EQ(lettering("\xc3\x84", 20, 1000).width, lettering("A", 20, 1000).width);
    EXPECT_NE(lettering("\xc3\x84", 20, 1000).ink, lettering("A", 20, 1000).ink);
}

}  // namespace
}  // namespace regather::capture
