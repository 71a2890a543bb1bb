// capture/images/lettering.h -- words in pictures: one line of DejaVu Sans, drawn by FreeType.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

namespace regather::capture {

/// How much of each pixel is ink, 0 to 255, in row order.
struct Lettering {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> ink;
};

/// `text` (UTF-8; what is none is left out) with an em of `size` pixels. Every line of a size is equally
/// high, from the highest ascent to the lowest descent of the font; as wide as its letters, but letters that
/// would pass `most_width` are left out. Not hinted: the same pixels from every configuration of FreeType.
/// Throws std::runtime_error when the font cannot be read.
Lettering lettering(std::string_view text, std::uint32_t size, std::uint32_t most_width);

}  // namespace regather::capture
