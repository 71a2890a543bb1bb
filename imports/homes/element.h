// imports/homes/element.h -- XML read strictly: every value knows the element and the line where it stands,
// so that each refusal is one line "FILE: line N: wall[3].thickness: found X, expected Y" (trace::DataError).
// Parsed by pugixml, which recurses nowhere and knows the five entities of XML only: a document cannot make
// itself larger than it is.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>

namespace regather::imports {

/// Elements and attributes that a document may have, counted by '<' and '='; each takes about 50 bytes of
/// memory.
inline constexpr std::uint64_t most_xml_items = 4'000'000;

class Element;

class XmlDocument {
public:
    /// UTF-8. DataError "FILE: line N: ..." for damaged XML, another encoding, an attribute that stands twice
    /// in an element, a root that has another name, or text or a further element beside it. Keeps `bytes` and
    /// `file`: they must live as long.
    XmlDocument(std::span<const std::uint8_t> bytes, const std::string& file, const char* root);
    XmlDocument(const XmlDocument&) = delete;
    XmlDocument& operator=(const XmlDocument&) = delete;

    Element root() const;
    const std::string& file() const { return file_; }
    std::size_t line_of(pugi::xml_node node) const;  ///< From 1.

private:
    std::span<const std::uint8_t> bytes_;
    const std::string& file_;
    pugi::xml_document document_;
};

/// An element and its place ("wall[3]").
class Element {
public:
    Element(pugi::xml_node node, std::string place, const XmlDocument& document)
        : node_(node), place_(std::move(place)), document_(&document) {}

    [[noreturn]] void fail(std::string_view field, std::string_view found, std::string_view expected) const;
    [[noreturn]] void fail(std::string_view found, std::string_view expected) const;

    std::string_view name() const { return node_.name(); }
    bool has(const char* field) const { return !node_.attribute(field).empty(); }
    /// The attribute's value, "" when it is not there: any bytes.
    std::string_view raw(const char* field) const { return node_.attribute(field).value(); }
    /// On one line of 200 bytes at most: what may be shown and written on.
    std::string text(const char* field) const;
    bool truth(const char* field, bool otherwise) const;

    /// In [low, high]; `otherwise` when it is not there, which is an error when there is none.
    double number(const char* field, double low, double high, std::optional<double> otherwise = {}) const;
    /// In [0, 1].
    std::optional<double> share(const char* field) const;
    /// sRGB from eight hexadecimal digits: alpha, red, green, blue.
    std::optional<std::array<std::uint8_t, 3>> color(const char* field) const;
    /// Nine numbers in [-1, 1], by rows.
    std::optional<std::array<double, 9>> rotation(const char* field) const;

    pugi::xml_node node() const { return node_; }
    Element child(pugi::xml_node node, std::size_t index) const;

private:
    double parsed(const char* field, std::string_view text, double low, double high) const;

    pugi::xml_node node_;
    std::string place_;
    const XmlDocument* document_;
};

}  // namespace regather::imports
