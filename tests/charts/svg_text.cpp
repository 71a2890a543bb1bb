#include "tests/charts/svg_text.h"

#include <fmt/format.h>
#include <ft2build.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <regex>
#include <stdexcept>
#include <string_view>
#include FT_FREETYPE_H

namespace regather::charts {
namespace {

/// Heights of capitals and depths of g and y in DejaVu Sans, in the font's size.
constexpr double ascent = 0.74, descent = 0.2;
/// Boxes that touch by less [SVG pixels] are apart to the eye: letters do not fill their boxes.
constexpr double slack = 0.75;

class Font {
public:
    Font() {
        if (FT_Init_FreeType(&library_) != 0 || FT_New_Face(library_, REGATHER_FONT, 0, &face_) != 0)
            throw std::runtime_error(std::string(REGATHER_FONT) + ": not a font");
    }
    ~Font() {
        FT_Done_Face(face_);
        FT_Done_FreeType(library_);
    }
    Font(const Font&) = delete;
    Font& operator=(const Font&) = delete;

    double width(const std::string& utf8, double size) const {
        double sum = 0;
        for (std::size_t at = 0; at < utf8.size();) {
            const auto byte = static_cast<unsigned char>(utf8[at]);
            const int more = byte < 0x80 ? 0 : byte < 0xE0 ? 1 : byte < 0xF0 ? 2 : 3;
            std::uint32_t letter = more == 0 ? byte : byte & (0x3Fu >> more);
            for (int i = 1; i <= more; ++i)
                letter =
                    letter << 6 | (static_cast<unsigned char>(utf8[at + static_cast<std::size_t>(i)]) & 0x3F);
            at += static_cast<std::size_t>(more) + 1;
            if (FT_Load_Char(face_, letter, FT_LOAD_NO_SCALE) != 0)
                throw std::runtime_error("no such letter");
            sum += static_cast<double>(face_->glyph->advance.x);
        }
        return sum / face_->units_per_EM * size;
    }

private:
    FT_Library library_{};
    FT_Face face_{};
};

std::string plain(std::string markup) {
    markup = std::regex_replace(markup, std::regex("<[^>]*>"), "");
    const std::pair<const char*, const char*> entities[] = {
        {"&lt;", "<"}, {"&gt;", ">"}, {"&#160;", " "}, {"&amp;", "&"}};
    for (const auto& [entity, letter] : entities)
        markup = std::regex_replace(markup, std::regex(entity), letter);
    return markup;
}

double number(const std::string& text) {
    return std::stod(text);
}

double overlap(double a_low, double a_high, double b_low, double b_high) {
    return std::min(a_high, b_high) - std::max(a_low, b_low);
}

}  // namespace

std::vector<Text> texts_of(const std::string& svg) {
    static const Font font;
    static const std::regex group(
        R"re(<g transform="translate\(([-\d.]+),([-\d.]+)\)(?: rotate\(([-\d.]+)\))?"[^>]*font-size="([\d.]+)"\s+text-anchor="(\w+)">\s*<text>([^\n]*)</text>)re");
    std::vector<Text> out;
    std::size_t seen = 0;
    for (std::sregex_iterator at(svg.begin(), svg.end(), group), end; at != end; ++at) {
        ++seen;
        const std::string words = plain((*at)[6]);
        if (words.empty()) continue;
        const double x = number((*at)[1]), y = number((*at)[2]), size = number((*at)[4]);
        const double width = font.width(words, size);
        const std::string anchor = (*at)[5];
        const double from = anchor == "start" ? 0 : anchor == "middle" ? -width / 2 : -width;
        const double degrees = (*at)[3].matched ? number((*at)[3]) : 0;
        if (degrees == 0)
            out.push_back({words, x + from, y - ascent * size, x + from + width, y + descent * size});
        else if (degrees == -90)
            out.push_back({words, x - ascent * size, y - from - width, x + descent * size, y - from});
        else
            throw std::runtime_error("a text at " + (*at)[3].str() + " degrees");
    }
    std::size_t all = 0;
    for (std::size_t at = 0; (at = svg.find("<text>", at)) != svg.npos; ++at) ++all;
    if (seen != all)
        throw std::runtime_error(fmt::format("{} of {} texts are written in another way", all - seen, all));
    return out;
}

std::vector<std::string> collisions(const std::string& svg) {
    const std::vector<Text> all = texts_of(svg);
    std::smatch size;
    if (!std::regex_search(svg, size, std::regex(R"re(width="(\d+)" height="(\d+)")re")))
        throw std::runtime_error("no size");
    const double width = number(size[1]), height = number(size[2]);
    std::vector<std::string> out;
    for (std::size_t a = 0; a < all.size(); ++a) {
        const Text& one = all[a];
        if (one.left < 0 || one.top < 0 || one.right > width || one.bottom > height)
            out.push_back(fmt::format("\"{}\" leaves the picture: {:.0f} to {:.0f}, {:.0f} to {:.0f}",
                                      one.words, one.left, one.right, one.top, one.bottom));
        for (std::size_t b = a + 1; b < all.size(); ++b) {
            const Text& other = all[b];
            if (overlap(one.left, one.right, other.left, other.right) > slack &&
                overlap(one.top, one.bottom, other.top, other.bottom) > slack)
                out.push_back(fmt::format("\"{}\" lies on \"{}\"", one.words, other.words));
        }
    }
    static const std::regex marker(
        R"re(<use xlink:href='#gpPt\d+' transform='translate\(([-\d.]+),([-\d.]+)\))re");
    for (std::sregex_iterator at(svg.begin(), svg.end(), marker), end; at != end; ++at) {
        const double x = number((*at)[1]), y = number((*at)[2]);
        for (const Text& text : all)
            if (x > text.left && x < text.right && y > text.top && y < text.bottom)
                out.push_back(fmt::format("a marker at {:.0f},{:.0f} lies on \"{}\"", x, y, text.words));
    }
    return out;
}

}  // namespace regather::charts
