#include "capture/images/lettering.h"

#include <fmt/format.h>
#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <type_traits>

#include "trace/text.h"

namespace regather::capture {
namespace {

struct Close {
    void operator()(FT_Library library) const { FT_Done_FreeType(library); }
    void operator()(FT_Face face) const { FT_Done_Face(face); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Close>;

/// The code point that opens `text`, which is taken off; a byte that opens none is 0.
FT_ULong next_letter(std::string_view& text) {
    const std::size_t length = trace::utf8_length(text);
    FT_ULong letter = 0;
    if (length == 1) letter = static_cast<unsigned char>(text[0]);
    if (length > 1) letter = static_cast<unsigned char>(text[0]) & (0xffu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i)
        letter = letter << 6 | (static_cast<unsigned char>(text[i]) & 0x3fu);
    text.remove_prefix(std::max<std::size_t>(length, 1));
    return letter;
}

}  // namespace

Lettering lettering(std::string_view text, std::uint32_t size, std::uint32_t most_width) {
    FT_Library opened = nullptr;
    FT_Face read = nullptr;
    if (FT_Init_FreeType(&opened) != 0) throw std::runtime_error("FreeType cannot be started");
    const Owned<FT_Library> library(opened);
    if (FT_New_Face(library.get(), REGATHER_FONT, 0, &read) != 0)
        throw std::runtime_error(
            fmt::format("{}: found no font that can be read, expected DejaVu Sans (Debian package "
                        "fonts-dejavu-core)",
                        REGATHER_FONT));
    const Owned<FT_Face> face(read);
    FT_Set_Pixel_Sizes(face.get(), 0, size);
    const auto whole = [](FT_Pos parts) { return static_cast<int>(parts >> 6); };  // from 1/64 pixels
    const int ascent = whole(face->size->metrics.ascender + 63);
    const int descent = whole(63 - face->size->metrics.descender);

    Lettering line{0, static_cast<std::uint32_t>(ascent + descent), {}};
    // As wide as it may become; cut at the end.
    const auto row_width = static_cast<int>(std::min<std::size_t>(most_width, (text.size() + 1) * 2 * size));
    line.ink.assign(static_cast<std::size_t>(row_width) * line.height, 0);
    int pen = 0;
    while (!text.empty()) {
        const FT_ULong letter = next_letter(text);
        if (letter < ' ') continue;
        if (FT_Load_Char(face.get(), letter, FT_LOAD_RENDER | FT_LOAD_NO_HINTING) != 0) continue;
        const FT_GlyphSlot glyph = face->glyph;
        const int next = pen + whole(glyph->advance.x + 32);
        const int left = pen + glyph->bitmap_left, top = ascent - glyph->bitmap_top;
        const auto columns = static_cast<int>(glyph->bitmap.width),
                   rows = static_cast<int>(glyph->bitmap.rows);
        if (std::max(next, left + columns) > row_width) break;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) {
                const int to_x = left + x, to_y = top + y;
                if (to_x < 0 || to_y < 0 || to_y >= ascent + descent) continue;
                std::uint8_t& ink = line.ink[static_cast<std::size_t>(to_y) * row_width + to_x];
                ink = std::max(ink, glyph->bitmap.buffer[y * glyph->bitmap.pitch + x]);
            }
        line.width =
            static_cast<std::uint32_t>(std::max({static_cast<int>(line.width), next, left + columns}));
        pen = next;
    }
    for (std::uint32_t y = 1; y < line.height; ++y)
        std::copy_n(line.ink.begin() + static_cast<std::ptrdiff_t>(y) * row_width, line.width,
                    line.ink.begin() + static_cast<std::ptrdiff_t>(y) * line.width);
    line.ink.resize(std::size_t{line.width} * line.height);
    return line;
}

}  // namespace regather::capture
