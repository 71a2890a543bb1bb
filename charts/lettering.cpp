#include "charts/lettering.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "results/table.h"
#include "trace/text.h"

namespace regather::charts {
namespace {

constexpr double em = 2048;
/// Advances of ' ' to '~' in DejaVu Sans 2.37, from the font's table hmtx.
constexpr std::array<std::uint16_t, 95> advances = {
    651,  821,  942,  1716, 1303, 1946, 1597, 563,  799,  799,  1024, 1716, 651,  739,  651,  690,
    1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 690,  690,  1716, 1716, 1716, 1087,
    2048, 1401, 1405, 1430, 1577, 1294, 1178, 1587, 1540, 604,  604,  1343, 1141, 1767, 1532, 1612,
    1235, 1612, 1423, 1300, 1251, 1499, 1401, 2025, 1403, 1251, 1403, 799,  690,  799,  1716, 1024,
    1024, 1255, 1300, 1126, 1300, 1260, 721,  1300, 1298, 569,  569,  1186, 569,  1995, 1298, 1253,
    1300, 1300, 842,  1067, 803,  1298, 1212, 1675, 1212, 1212, 1075, 1303, 690,  1303, 1716};
constexpr double other_advance = 1716;

/// The first of the separators that the text has.
std::string_view separator_of(std::string_view text) {
    for (const std::string_view separator : {" · ", "; ", " "})
        if (text.find(separator) != text.npos) return separator;
    return {};
}

}  // namespace

std::string drawable(std::string_view text) {
    constexpr std::string_view replacement = "\xEF\xBF\xBD";
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = trace::utf8_length(text.substr(i));
        const std::string_view letter = text.substr(i, std::max<std::size_t>(length, 1));
        i += letter.size();
        const auto first = static_cast<unsigned char>(letter[0]);
        if (length == 1)
            out += first < ' ' || first == 127 ? ' ' : letter[0];
        else if (length == 0 || letter == "\xEF\xBF\xBE" || letter == "\xEF\xBF\xBF")
            out += replacement;
        else
            out += letter;
    }
    return out;
}

double text_width(std::string_view utf8, double font_size) {
    double sum = 0;
    for (const char c : utf8) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= ' ' && byte <= '~')
            sum += advances[byte - std::size_t{' '}];
        else if ((byte >> 6) != 2)
            sum += other_advance;
    }
    return sum / em * font_size;
}

std::vector<std::string> wrapped(std::string_view text, double font_size, double width) {
    if (text.empty()) return {};
    const std::string_view separator = separator_of(text);
    if (separator.empty() || text_width(text, font_size) <= width) return {std::string(text)};
    const std::string_view tail = separator == "; " ? ";" : "";  // stays at the end of a line
    std::vector<std::string> out;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(separator, at), text.size());
        const std::string part =
            std::string(text.substr(at, end - at)) + std::string(end < text.size() ? tail : "");
        const std::string joined =
            out.empty() ? part : out.back() + std::string(separator.substr(tail.size())) + part;
        if (!out.empty() && text_width(joined, font_size) <= width) {
            out.back() = joined;
        } else {
            for (std::string& line : wrapped(part, font_size, width)) out.push_back(std::move(line));
        }
        at = end + separator.size();
    }
    return out;
}

std::string fitting(std::string_view text, double font_size, double width) {
    std::string out(text);
    for (std::size_t most = results::letters(text); most > 4 && text_width(out, font_size) > width; --most)
        out = results::cut(text, most - 1);
    return out;
}

}  // namespace regather::charts
