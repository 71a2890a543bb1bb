#include "imports/homes/element.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::imports {

using trace::DataError;
using trace::in_quotes;

namespace {

std::string_view text_of(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::size_t line_at(std::string_view text, std::ptrdiff_t offset) {
    const std::size_t end =
        std::min(text.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
    return 1 + static_cast<std::size_t>(
                   std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
}

std::string_view damage_of(pugi::xml_parse_status status) {
    switch (status) {
        case pugi::status_unrecognized_tag:
            return "a tag that begins with neither a name, '/', '?' nor '!'";
        case pugi::status_bad_pi:
            return "a declaration <? that does not end";
        case pugi::status_bad_comment:
            return "a comment that does not end";
        case pugi::status_bad_cdata:
            return "a CDATA section that does not end";
        case pugi::status_bad_doctype:
            return "a DOCTYPE that does not end";
        case pugi::status_bad_pcdata:
            return "text outside any element";
        case pugi::status_bad_start_element:
            return "a start tag that does not end";
        case pugi::status_bad_attribute:
            return "an attribute that is not name=\"value\"";
        case pugi::status_bad_end_element:
            return "an end tag that does not end";
        case pugi::status_end_element_mismatch:
            return "an end tag of another element than the one that is open, or none";
        case pugi::status_no_document_element:
            return "no element";
        default:
            return "damaged text";
    }
}

// What the declaration <?xml encoding="..."?> says; "" when it says nothing.
std::string_view declared_encoding(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    if (!text.starts_with("<?xml")) return {};
    text = text.substr(0, text.find("?>"));
    const std::size_t key = text.find("encoding");
    if (key == std::string_view::npos) return {};
    const std::size_t first = text.find_first_of("'\"", key);
    if (first == std::string_view::npos) return {};
    const std::size_t last = text.find(text[first], first + 1);
    return last == std::string_view::npos ? std::string_view{} : text.substr(first + 1, last - first - 1);
}

bool is_utf8(std::string_view name) {
    std::string lower(name);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower.empty() || lower == "utf-8" || lower == "utf8" || lower == "us-ascii" || lower == "ascii";
}

}  // namespace

XmlDocument::XmlDocument(std::span<const std::uint8_t> bytes, const std::string& file, const char* root)
    : bytes_(bytes), file_(file) {
    const std::string_view text = text_of(bytes);
    const auto refuse = [&](std::ptrdiff_t offset, std::string_view found, std::string_view expected) {
        throw DataError(
            fmt::format("{}: line {}: found {}, expected {}", file, line_at(text, offset), found, expected));
    };
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") ||
        text.substr(0, 64).find('\0') != std::string_view::npos)
        refuse(0, "XML in another encoding", "UTF-8");
    if (const std::string_view encoding = declared_encoding(text); !is_utf8(encoding))
        refuse(0, fmt::format("the encoding {}", in_quotes(encoding)), "UTF-8");
    const auto items = static_cast<std::uint64_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return c == '<' || c == '='; }));
    if (items > most_xml_items)
        throw DataError(fmt::format("{}: found {} elements and attributes, expected at most {}", file, items,
                                    most_xml_items));
    const pugi::xml_parse_result result = document_.load_buffer(
        bytes.data(), bytes.size(), pugi::parse_default | pugi::parse_fragment, pugi::encoding_utf8);
    const std::string expected = fmt::format("a <{}> in XML", root);
    if (!result) refuse(result.offset, damage_of(result.status), expected);
    const pugi::xml_node element = document_.document_element();
    // A text begins with the blanks before it.
    const auto first_of = [&](pugi::xml_node node) {
        const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
        return static_cast<std::ptrdiff_t>(std::min(text.find_first_not_of(" \t\r\n", offset), text.size()));
    };
    for (const pugi::xml_node node : document_)
        if (node != element)
            refuse(first_of(node),
                   node.type() == pugi::node_element
                       ? fmt::format("the element {} beside another one", in_quotes(node.name()))
                       : std::string(damage_of(pugi::status_bad_pcdata)),
                   expected + ", and nothing beside it");
    if (!element) refuse(0, damage_of(pugi::status_no_document_element), expected);
    if (std::string_view(element.name()) != root)
        refuse(element.offset_debug(), fmt::format("the element {}", in_quotes(element.name())),
               fmt::format("<{}>", root));
}

Element XmlDocument::root() const {
    return {document_.document_element(), document_.document_element().name(), *this};
}

std::size_t XmlDocument::line_of(pugi::xml_node node) const {
    return line_at(text_of(bytes_), node.offset_debug());
}

void Element::fail(std::string_view field, std::string_view found, std::string_view expected) const {
    throw DataError(fmt::format("{}: line {}: {}.{}: found {}, expected {}", document_->file(),
                                document_->line_of(node_), place_, field, found, expected));
}

void Element::fail(std::string_view found, std::string_view expected) const {
    throw DataError(fmt::format("{}: line {}: {}: found {}, expected {}", document_->file(),
                                document_->line_of(node_), place_, found, expected));
}

std::string Element::text(const char* field) const {
    return trace::shown(raw(field), 200);
}

bool Element::truth(const char* field, bool otherwise) const {
    if (!has(field)) return otherwise;
    const std::string_view value = raw(field);
    if (value != "true" && value != "false") fail(field, in_quotes(value), "true or false");
    return value == "true";
}

double Element::number(const char* field, double low, double high, std::optional<double> otherwise) const {
    if (has(field)) return parsed(field, raw(field), low, high);
    if (!otherwise) fail(field, "nothing", "a number");
    return *otherwise;
}

std::optional<double> Element::share(const char* field) const {
    return has(field) ? std::optional(number(field, 0, 1)) : std::nullopt;
}

std::optional<std::array<std::uint8_t, 3>> Element::color(const char* field) const {
    if (!has(field)) return {};
    const std::string_view digits = raw(field);
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (error != std::errc{} || end != digits.data() + digits.size() || digits.size() > 8)
        fail(field, in_quotes(digits), "a colour of eight hexadecimal digits");
    return std::array{static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
                      static_cast<std::uint8_t>(value)};
}

std::optional<std::array<double, 9>> Element::rotation(const char* field) const {
    if (!has(field)) return {};
    std::string_view rest = raw(field);
    std::array<double, 9> rows{};
    for (double& value : rows) {
        rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
        const std::size_t length = std::min(rest.find(' '), rest.size());
        value = parsed(field, rest.substr(0, length), -1.001, 1.001);
        rest.remove_prefix(length);
    }
    if (rest.find_first_not_of(' ') != std::string_view::npos)
        fail(field, in_quotes(raw(field)), "nine numbers");
    return rows;
}

Element Element::child(pugi::xml_node node, std::size_t index) const {
    return {node, fmt::format("{}.{}[{}]", place_, trace::shown(node.name(), 40), index), *document_};
}

double Element::parsed(const char* field, std::string_view text, double low, double high) const {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !(value >= low && value <= high))
        fail(field, in_quotes(text), fmt::format("a number from {} to {}", low, high));
    return value;
}

}  // namespace regather::imports
