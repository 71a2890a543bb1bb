#include "meshes/glb.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "trace/error.h"

namespace regather::meshes {

namespace {

constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;
constexpr std::uint32_t json_type = 0x4E4F534A, binary_type = 0x004E4942;

std::uint32_t word(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    return value;
}

int digit(char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

}  // namespace

bool is_glb(std::string_view bytes) {
    return bytes.starts_with("glTF");
}

Glb read_glb(std::string_view bytes, const std::string& file, Notes& notes) {
    const auto fail = [&](std::size_t at, const std::string& found, const std::string& expected) {
        throw trace::DataError(
            fmt::format("{}: byte {}: found {}, expected {}", file, at + 1, found, expected));
    };
    if (bytes.size() < header_bytes) fail(bytes.size(), "the end of the file", "a GLB header");
    if (word(bytes, 4) != 2) fail(4, fmt::format("version {} of GLB", word(bytes, 4)), "2");
    const std::size_t length = word(bytes, 8);
    if (length > bytes.size())
        fail(8, fmt::format("a GLB of {} bytes", length), fmt::format("at most the file's {}", bytes.size()));
    notes.add("bytes behind the end of the GLB are not read", bytes.size() - length);
    bytes = bytes.substr(0, length);
    Glb glb;
    bool has_json = false;
    for (std::size_t at = header_bytes; at < bytes.size();) {
        if (bytes.size() - at < chunk_header_bytes) fail(at, "a chunk that is cut", "its length and type");
        const std::size_t size = word(bytes, at), begin = at + chunk_header_bytes;
        const std::uint32_t type = word(bytes, at + 4);
        if (size > bytes.size() - begin)
            fail(at, fmt::format("a chunk of {} bytes", size),
                 fmt::format("at most {}", bytes.size() - begin));
        if (has_json == (type == json_type))
            fail(at, has_json ? "a second JSON chunk" : "a chunk of another type",
                 "one JSON chunk, the first");
        const std::string_view content = bytes.substr(begin, size);
        if (type == json_type) {
            glb.json = content;
            has_json = true;
        } else if (type == binary_type && !glb.binary) {
            glb.binary = content;
        } else {
            notes.add("further chunks of the GLB are not read");
        }
        at = begin + size;
    }
    if (!has_json) fail(header_bytes, "the end of the file", "a JSON chunk");
    return glb;
}

std::optional<std::string> from_base64(std::string_view text) {
    const std::size_t end = text.find_last_not_of('=');
    const std::size_t padding = text.size() - (end == text.npos ? 0 : end + 1);
    text.remove_suffix(padding);
    if (padding > 2 || text.size() % 4 == 1 || (padding > 0 && (text.size() + padding) % 4 != 0))
        return std::nullopt;
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                          : c >= 'a' && c <= 'z' ? c - 'a' + 26
                          : c >= '0' && c <= '9' ? c - '0' + 52
                          : c == '+'             ? 62
                          : c == '/'             ? 63
                                                 : -1;
        if (value < 0) return std::nullopt;
        bits = (bits << 6) | static_cast<std::uint32_t>(value);
        if ((count += 6) >= 8) bytes.push_back(static_cast<char>((bits >> (count -= 8)) & 0xFF));
    }
    return bytes;
}

std::string without_percent_codes(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
            text.push_back(static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2])));
            i += 2;
        } else {
            text.push_back(uri[i]);
        }
    }
    return text;
}

bool leaves_the_disk_or_is_absolute(std::string_view uri) {
    if (uri.starts_with('/') || uri.starts_with('\\')) return true;
    const std::size_t colon = uri.find(':');
    return colon != uri.npos && colon > 0 &&
           std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                      c == '+' || c == '.' || c == '-';
           });
}

}  // namespace regather::meshes
