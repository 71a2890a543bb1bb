#include "trace/text.h"

#include <fmt/format.h>

#include <algorithm>

namespace regather::trace {

namespace {

std::uint32_t code_point(std::string_view character) {
    const auto byte = [&](std::size_t i) {
        return static_cast<std::uint32_t>(static_cast<unsigned char>(character[i]));
    };
    if (character.size() == 1) return byte(0);
    std::uint32_t code = byte(0) & (0x7fu >> character.size());
    for (std::size_t i = 1; i < character.size(); ++i) code = code << 6 | (byte(i) & 0x3f);
    return code;
}

bool is_invisible(std::uint32_t code) {
    return (code >= 0x80 && code < 0xa0) || code == 0xad || code == 0x61c ||
           (code >= 0x200b && code <= 0x200f) || (code >= 0x2028 && code <= 0x202e) ||
           (code >= 0x2060 && code <= 0x206f) || code == 0xfeff || (code >= 0xfff9 && code <= 0xfffb) ||
           (code >= 0xe0000 && code <= 0xe007f);
}

std::string escaped(std::string_view text, std::size_t most_bytes, std::string_view specials) {
    std::string line;
    std::size_t i = 0;
    while (i < text.size()) {
        const std::size_t length = utf8_length(text.substr(i));
        const std::size_t step = std::max<std::size_t>(length, 1);
        if (i + step > most_bytes) return line + "...";
        const std::string_view character = text.substr(i, step);
        const unsigned char byte = static_cast<unsigned char>(character[0]);
        i += step;
        if (length > 1) {
            const std::uint32_t code = code_point(character);
            if (is_invisible(code)) {
                line += fmt::format("\\u{{{:x}}}", code);
            } else {
                line += character;
            }
        } else if (byte == '\n' || byte == '\t' || byte == '\r') {
            line += byte == '\n' ? "\\n" : byte == '\t' ? "\\t" : "\\r";
        } else if (length == 0 || byte < ' ' || byte == 127) {
            line += fmt::format("\\x{:02x}", byte);
        } else {
            if (specials.find(character[0]) != specials.npos) line += '\\';
            line += character[0];
        }
    }
    return line;
}

}  // namespace

std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) -> unsigned {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
    };
    const auto continues = [&](std::size_t i) { return (byte(i) & 0xc0) == 0x80; };
    if (text.empty()) return 0;
    const unsigned first = byte(0), second = byte(1);
    if (first < 0x80) return 1;
    if (first < 0xc2 || first > 0xf4 || !continues(1)) return 0;
    if (first < 0xe0) return 2;
    if (!continues(2)) return 0;
    if (first < 0xf0) return (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ? 0 : 3;
    if (!continues(3)) return 0;
    return (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f) ? 0 : 4;
}

std::string shown(std::string_view text, std::size_t most_bytes) {
    return escaped(text, most_bytes, "");
}

std::string in_quotes(std::string_view text, std::size_t most_bytes) {
    return '"' + escaped(text, most_bytes, "\"\\") + '"';
}

}  // namespace regather::trace
