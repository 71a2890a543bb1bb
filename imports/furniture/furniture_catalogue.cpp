#include "imports/furniture/furniture_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "trace/error.h"
#include "trace/text.h"

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

std::string_view trimmed_start(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t' || text.front() == '\f'))
        text.remove_prefix(1);
    return text;
}

// A line whose last backslash is not one of a pair goes on in the next.
bool goes_on(std::string_view line) {
    const std::size_t last = line.find_last_not_of('\\');
    return (line.size() - (last == std::string_view::npos ? 0 : last + 1)) % 2 == 1;
}

class Properties {
public:
    Properties(std::string_view text, std::string_view file) : text_(text), file_(file) {}

    std::map<std::string, std::string, std::less<>> read() {
        std::map<std::string, std::string, std::less<>> values;
        while (!text_.empty()) {
            const std::string line = logical_line();
            if (line.empty() || line.front() == '#' || line.front() == '!') continue;
            std::size_t end = 0;  // of the key: the first '=', ':' or blank that has no backslash before it
            while (end < line.size() && std::string_view("=: \t\f").find(line[end]) == std::string_view::npos)
                end += line[end] == '\\' ? 2 : 1;
            end = std::min(end, line.size());
            std::string_view value = trimmed_start(std::string_view(line).substr(end));
            if (!value.empty() && (value.front() == '=' || value.front() == ':')) value.remove_prefix(1);
            values[decoded(std::string_view(line).substr(0, end))] = decoded(trimmed_start(value));
        }
        return values;
    }

private:
    // The next line and those in which it goes on, without the blanks before each.
    std::string logical_line() {
        std::string line;
        for (bool first = true;; first = false) {
            const std::size_t end = std::min(text_.find('\n'), text_.size());
            std::string_view part = trimmed_start(text_.substr(0, end));
            if (!part.empty() && part.back() == '\r') part.remove_suffix(1);
            text_.remove_prefix(std::min(end + 1, text_.size()));
            ++number_;
            const bool comment = first && !part.empty() && (part.front() == '#' || part.front() == '!');
            if (comment || !goes_on(part)) return line.append(part);
            line.append(part.substr(0, part.size() - 1));
            if (text_.empty()) return line;
        }
    }

    std::string decoded(std::string_view raw) const {
        std::string text;
        for (std::size_t i = 0; i < raw.size(); ++i) {
            unsigned code = static_cast<unsigned char>(raw[i]);
            if (code == '\\' && i + 1 < raw.size()) {
                const char next = raw[++i];
                code = static_cast<unsigned char>(next);
                if (next == 't' || next == 'n' || next == 'r' || next == 'f') code = ' ';
                if (next == 'u') {
                    const std::string_view digits = raw.substr(i + 1, 4);
                    const auto [end, error] =
                        std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
                    if (error != std::errc{} || digits.size() < 4 || end != digits.data() + 4)
                        throw trace::DataError(
                            fmt::format("{}: line {}: found {}, expected four hexadecimal digits after \\u",
                                        file_, number_, trace::in_quotes(digits)));
                    i += 4;
                }
            }
            const bool surrogate = code >= 0xd800 && code < 0xe000;
            append_utf8(text, code < 32 ? ' ' : surrogate ? '?' : code);
        }
        while (!text.empty() && text.back() == ' ') text.pop_back();
        return text;
    }

    std::string_view text_, file_;
    std::size_t number_ = 0;
};

}  // namespace

std::map<std::string, std::string, std::less<>> read_properties(std::string_view text,
                                                                std::string_view file) {
    return Properties(text, file).read();
}

FurnitureCatalogue::FurnitureCatalogue(const std::filesystem::path& file) : zip_(Zip::open(file)) {
    const std::vector<std::uint8_t> bytes = zip_.read(properties_entry, most_properties_bytes);
    values_ = read_properties({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                              fmt::format("{}: {}", zip_.archive(), properties_entry));
}

void FurnitureCatalogue::count_left_out(LeftOut& left_out) const {
    constexpr std::array<std::string_view, 4> used{"model", "creator", "name", "license"};
    for (const auto& [key, value] : values_) {
        const std::string_view stem = std::string_view(key).substr(0, key.find('#'));
        const bool of_piece = stem.size() < key.size();
        const bool is_used = std::find(used.begin(), used.end(), stem) != used.end() &&
                             of_piece == (stem == "model" || stem == "creator");
        if (!is_used) left_out.add("of catalogues", of_piece ? fmt::format("{}#", stem) : std::string(stem));
    }
}

std::size_t FurnitureCatalogue::models() const {
    return static_cast<std::size_t>(std::count_if(
        values_.begin(), values_.end(), [](const auto& pair) { return pair.first.starts_with("model#"); }));
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
