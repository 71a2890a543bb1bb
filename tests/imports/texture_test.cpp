// Textures by hand, byte for byte, and by the encoders of their own libraries.
#include "imports/texture.h"

#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>

#include <cmath>

#include "imports/texture_colour.h"
#include "trace/error.h"

namespace regather::imports {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Texel = std::array<std::uint8_t, 4>;

/// 18 bytes of header for an image of 3 x 2 texels, then `data`.
Bytes targa(std::uint8_t type, std::uint8_t bits, const Bytes& data, Bytes palette = {0, 0, 0, 0, 0},
            std::uint8_t has_palette = 0, std::uint8_t descriptor = 0) {
    Bytes bytes{0, has_palette, type};
    bytes.insert(bytes.end(), palette.begin(), palette.end());
    for (const int value : {0, 0, 0, 0, 3, 0, 2, 0}) bytes.push_back(static_cast<std::uint8_t>(value));
    bytes.push_back(bits);
    bytes.push_back(descriptor);
    bytes.insert(bytes.end(), data.begin(), data.end());
    return bytes;
}

std::vector<Texel> texels(const Bytes& bytes, const std::string& name = "a.tga") {
    const Texture texture = read_texture(bytes, name);
    EXPECT_EQ(texture.width, 3u);
    EXPECT_EQ(texture.height, 2u);
    return texture.texels;
}

std::string refusal(const Bytes& bytes, const std::string& name = "a.tga") {
    try {
        read_texture(bytes, name);
    } catch (const trace::DataError& error) {
        return error.what();
    }
    return "nothing";
}

const std::vector<Texel> six{{3, 2, 1, 255},    {6, 5, 4, 255},    {9, 8, 7, 255},
                             {12, 11, 10, 255}, {15, 14, 13, 255}, {18, 17, 16, 255}};

TEST(Targa, PlainColourIsBlueGreenRed) {
    EXPECT_EQ(texels(targa(2, 24, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18})), six);
}

TEST(Targa, ThirtyTwoBitsHaveAlphaWhateverTheHeaderCallsIt) {
    const Bytes data{1, 2, 3, 90, 1, 2, 3, 0, 1, 2, 3, 255, 1, 2, 3, 7, 1, 2, 3, 8, 1, 2, 3, 9};
    const std::vector<Texel> expected{{3, 2, 1, 90}, {3, 2, 1, 0}, {3, 2, 1, 255},
                                      {3, 2, 1, 7},  {3, 2, 1, 8}, {3, 2, 1, 9}};
    EXPECT_EQ(texels(targa(2, 32, data)), expected);
    EXPECT_EQ(texels(targa(2, 32, data, {0, 0, 0, 0, 0}, 0, 8)), expected);
}

TEST(Targa, SixteenBitsAreFiveOfEachAndOneThatShows) {
    // red 31, green 0, blue 1, with the topmost bit: 1 11111 00000 00001
    const Bytes data{0x01, 0xfc, 0x01, 0x7c, 0x40, 0x02, 0, 0, 0, 0, 0, 0};
    auto found = texels(targa(2, 16, data, {0, 0, 0, 0, 0}, 0, 1));
    EXPECT_EQ(found[0], (Texel{255, 0, 8, 255}));
    EXPECT_EQ(found[1], (Texel{255, 0, 8, 0}));
    EXPECT_EQ(found[2], (Texel{0, 148, 0, 0}));  // green 18: 10010 010
    EXPECT_EQ(texels(targa(2, 16, data))[1], (Texel{255, 0, 8, 255}));
}

TEST(Targa, RunsAndLiteralsFollowOneAnotherAcrossRows) {
    const std::vector<Texel> expected{{3, 2, 1, 255}, {3, 2, 1, 255}, {3, 2, 1, 255},
                                      {3, 2, 1, 255}, {6, 5, 4, 255}, {9, 8, 7, 255}};
    EXPECT_EQ(texels(targa(10, 24, {0x83, 1, 2, 3, 0x01, 4, 5, 6, 7, 8, 9})), expected);
}

TEST(Targa, GreyAndPalettes) {
    const std::vector<Texel> grey{{5, 5, 5, 255}, {6, 6, 6, 255}, {7, 7, 7, 255},
                                  {8, 8, 8, 255}, {9, 9, 9, 255}, {200, 200, 200, 255}};
    EXPECT_EQ(texels(targa(3, 8, {5, 6, 7, 8, 9, 200})), grey);
    EXPECT_EQ(texels(targa(11, 8, {0x02, 5, 6, 7, 0x01, 8, 9, 0x80, 200})), grey);
    // Two colours, of which the first has the number 7.
    const Bytes palette{7, 0, 2, 0, 24}, data{1, 2, 3, 40, 50, 60, 7, 8, 7, 8, 8, 8};
    const std::vector<Texel> coloured{{3, 2, 1, 255},    {60, 50, 40, 255}, {3, 2, 1, 255},
                                      {60, 50, 40, 255}, {60, 50, 40, 255}, {60, 50, 40, 255}};
    EXPECT_EQ(texels(targa(1, 8, data, palette, 1)), coloured);
    EXPECT_EQ(refusal(targa(1, 8, {1, 2, 3, 40, 50, 60, 7, 9, 7, 8, 8, 8}, palette, 1)),
              "a.tga: found colour 9 of a Targa palette, expected 2 entries from 7");
    EXPECT_EQ(refusal(targa(1, 8, {1, 2, 3, 40, 50, 60, 7, 6, 7, 8, 8, 8}, palette, 1)),
              "a.tga: found colour 6 of a Targa palette, expected 2 entries from 7");
}

TEST(Targa, ANameStandsBeforeTheTexels) {
    Bytes named = targa(3, 8, {'a', 'b', 5, 6, 7, 8, 9, 200});
    named[0] = 2;
    EXPECT_EQ(texels(named)[0], (Texel{5, 5, 5, 255}));
}

TEST(Targa, DamageIsRefused) {
    EXPECT_EQ(refusal({1, 2, 3}), "a.tga: found 3 bytes, expected the 18 of a Targa header and more");
    EXPECT_EQ(refusal(targa(3, 8, {5, 6, 7, 8, 9})),
              "a.tga: found 0 bytes before the end of the Targa data, expected 1 at least");
    EXPECT_EQ(refusal(targa(10, 24, {0x86, 1, 2, 3})),
              "a.tga: found a Targa run of 7 texels where 6 are left, expected no more than are left");
    EXPECT_EQ(refusal(targa(4, 8, {})), "a.tga: found Targa image type 4, expected 1, 2, 3, 9, 10 or 11");
    EXPECT_EQ(refusal(targa(2, 8, {})),
              "a.tga: found 8 bits a texel in a Targa image of type 2, expected 15, 16, 24 or 32");
    EXPECT_EQ(refusal(targa(1, 8, {})),
              "a.tga: found Targa palette type 0 in an image of type 1, expected 1");
    EXPECT_EQ(refusal(targa(2, 24, {}, {0, 0, 0, 0, 0}, 0, 0x40)),
              "a.tga: found a Targa image with interleaved rows, expected rows one after the other");
    Bytes empty = targa(3, 8, {});
    empty[12] = 0;
    EXPECT_EQ(refusal(empty), "a.tga: found 0 x 2 texels, expected 1 x 1 to 8192 x 8192");
    Bytes large = targa(3, 8, {});
    large[15] = 0x20, large[14] = 1;
    EXPECT_EQ(refusal(large), "a.tga: found 3 x 8193 texels, expected 1 x 1 to 8192 x 8192");
}

Bytes png(std::uint32_t format, const Bytes& values) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = 3, image.height = 2, image.format = format;
    png_alloc_size_t size = 0;
    png_image_write_to_memory(&image, nullptr, &size, 0, values.data(), 0, nullptr);
    Bytes bytes(size);
    png_image_write_to_memory(&image, bytes.data(), &size, 0, values.data(), 0, nullptr);
    return bytes;
}

TEST(PngTexture, IsWhatWasWritten) {
    const Bytes bytes = png(PNG_FORMAT_RGB, {3, 2, 1, 6, 5, 4, 9, 8, 7, 12, 11, 10, 15, 14, 13, 18, 17, 16});
    EXPECT_EQ(texels(bytes, "a.png"), six);
    EXPECT_EQ(texels(bytes, "a.jpg"), six);  // the bytes tell
    EXPECT_EQ(texels(png(PNG_FORMAT_GA, {5, 1, 6, 2, 7, 3, 8, 4, 9, 5, 10, 6}), "a.png")[4],
              (Texel{9, 9, 9, 5}));
    Bytes cut = bytes;
    cut.resize(cut.size() - 20);
    EXPECT_EQ(refusal(cut, "a.png"), "a.png: found damaged PNG data, expected an undamaged image");
    Bytes changed = bytes;
    changed[changed.size() - 25] ^= 1;  // within the compressed texels: the checksum tells
    EXPECT_EQ(refusal(changed, "a.png"), "a.png: found damaged PNG data, expected an undamaged image");
    EXPECT_EQ(refusal({'G', 'I', 'F', '8'}, "a.gif"),
              "a.gif: found another format, expected JPEG, PNG, or Targa in a file .tga");
}

/// One colour, 16 x 16 texels.
Bytes jpeg(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    Bytes rgb;
    for (int i = 0; i < 256; ++i) rgb.insert(rgb.end(), {r, g, b});
    const tjhandle encoder = tjInitCompress();
    unsigned char* out = nullptr;
    unsigned long size = 0;
    tjCompress2(encoder, rgb.data(), 16, 0, 16, TJPF_RGB, &out, &size, TJSAMP_444, 100, TJFLAG_ACCURATEDCT);
    const Bytes bytes(out, out + size);
    tjFree(out);
    tjDestroy(encoder);
    return bytes;
}

TEST(JpegTexture, IsWhatWasWrittenToARounding) {
    const Texture texture = read_texture(jpeg(200, 100, 30), "a.jpg");
    EXPECT_EQ(texture.texels.size(), 256u);
    EXPECT_NEAR(texture.texels[77][0], 200, 2);
    EXPECT_NEAR(texture.texels[77][1], 100, 2);
    EXPECT_NEAR(texture.texels[77][2], 30, 2);
    EXPECT_EQ(texture.texels[77][3], 255);
    Bytes cut = jpeg(200, 100, 30);
    cut.resize(cut.size() - 6);
    EXPECT_EQ(refusal(cut, "a.jpg"), "a.jpg: found damaged JPEG data, expected an undamaged image");
    EXPECT_EQ(refusal({0xff, 0xd8, 0xff}, "a.jpg"),
              "a.jpg: found damaged JPEG data, expected an undamaged image");
}

// sRGB 188 is 0.5029 in linear light, 255 is 1, 0 is 0 (IEC 61966-2-1).
TEST(MeanColour, IsTakenInLinearLightAndWeighsByAlpha) {
    const Bytes data{0, 255, 188, 255, 0, 255, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0};
    const trace::Vec3 mean = mean_colour(targa(2, 32, data), "a.tga");  // one texel shows
    EXPECT_NEAR(mean.x, 0.5029, 1e-4);
    EXPECT_EQ(mean.y, 1);
    EXPECT_EQ(mean.z, 0);
    const Bytes half{0, 0, 188, 255, 0, 0, 0, 51, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_NEAR(mean_colour(targa(2, 32, half), "a.tga").x, 0.5029 / 1.2, 1e-4);
    const Bytes hidden{0, 0, 188, 0, 0, 0, 188, 0, 0, 0, 188, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_NEAR(mean_colour(targa(2, 32, hidden), "a.tga").x, 0.5029 / 2, 1e-4);  // alpha that hides all
}

}  // namespace
}  // namespace regather::imports
