#include "imports/furniture/furniture_catalogue.h"

#include <algorithm>
#include <charconv>

#include "scenes/document.h"

namespace regather::imports {

namespace {

constexpr std::uint64_t most_properties_bytes = 16u << 20;
constexpr std::string_view properties_entry = "PluginFurnitureCatalog.properties";

void append_utf8(std::string& text, unsigned code) {
    if (code < 0x80) {
        text += static_cast<char>(code);
    } else if (code < 0x800) {
        text += static_cast<char>(0xc0 | (code >> 6));
        text += static_cast<char>(0x80 | (code & 0x3f));
    } else {
        text += static_cast<char>(0xe0 | (code >> 12));
        text += static_cast<char>(0x80 | ((code >> 6) & 0x3f));
        text += static_cast<char>(0x80 | (code & 0x3f));
    }
}

std::string decoded(std::string_view raw) {
    std::string text;
    for (std::size_t i = 0; i < raw.size(); ++i) {
        unsigned code = static_cast<unsigned char>(raw[i]);
        if (code == '\\' && i + 1 < raw.size()) {
            const char next = raw[++i];
            code = static_cast<unsigned char>(next);
            if (next == 'u' && i + 4 < raw.size()) {
                std::from_chars(raw.data() + i + 1, raw.data() + i + 5, code, 16);
                i += 4;
            }
        }
        const bool surrogate = code >= 0xd800 && code < 0xe000;
        append_utf8(text, code < 32 ? ' ' : surrogate ? '?' : code);
    }
    return text;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
        text.remove_suffix(1);
    return text;
}

}  // namespace

std::map<std::string, std::string, std::less<>> read_properties(std::string_view text) {
    std::map<std::string, std::string, std::less<>> values;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::size_t equals = line.find('=');
        if (line.empty() || line.front() == '#' || equals == std::string_view::npos) continue;
        values[decoded(trimmed(line.substr(0, equals)))] = decoded(trimmed(line.substr(equals + 1)));
    }
    return values;
}

FurnitureCatalogue::FurnitureCatalogue(const std::filesystem::path& file) : zip_(Zip::open(file)) {
    const std::vector<std::uint8_t> bytes = zip_.read(properties_entry, most_properties_bytes);
    values_ = read_properties({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string FurnitureCatalogue::value(std::string_view key) const {
    const auto found = values_.find(key);
    return found == values_.end() ? "" : found->second;
}

std::string FurnitureCatalogue::creator_of(const std::string& model) const {
    for (const auto& [key, path] : values_)
        if (key.starts_with("model#") && path == "/" + model) return value("creator#" + key.substr(6));
    return "";
}

}  // namespace regather::imports
