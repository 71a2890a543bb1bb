#include "trace/text.h"

#include <fmt/format.h>

#include <cstdint>

namespace regather::trace {

namespace {

struct Character {
    char32_t code = 0;
    std::size_t bytes = 0;  // 0: not UTF-8.
};

// The first character of a text that is not empty (RFC 3629: no surrogates, no overlong forms, at most
// U+10FFFF).
Character first_of(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    constexpr char32_t least[]{0, 0, 0x80, 0x800, 0x10000};
    if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return {};
    char32_t code = lead & (0xFFu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return {};
        code = (code << 6) | (byte(i) & 0x3Fu);
    }
    if (code < least[length] || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return {};
    return {code, length};
}

bool acts_on_a_terminal(char32_t c) {
    return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x061C || (c >= 0x200E && c <= 0x200F) ||
           (c >= 0x2028 && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069) || c == 0xFEFF;
}

}  // namespace

std::string in_quotes(std::string_view text, std::size_t most_bytes) {
    std::string line = "\"";
    for (std::size_t at = 0; at < text.size();) {
        const Character c = first_of(text.substr(at));
        const std::size_t bytes = c.bytes > 0 ? c.bytes : 1;
        if (at + bytes > most_bytes) {
            line += "...";
            break;
        }
        if (c.bytes == 0)
            line += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at]));
        else if (c.code == '"' || c.code == '\\')
            line.append(1, '\\').append(1, static_cast<char>(c.code));
        else if (c.code == '\n' || c.code == '\r' || c.code == '\t')
            line += c.code == '\n' ? "\\n" : c.code == '\r' ? "\\r" : "\\t";
        else if (acts_on_a_terminal(c.code))
            line += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(c.code));
        else
            line += text.substr(at, bytes);
        at += bytes;
    }
    return line + '"';
}

}  // namespace regather::trace
