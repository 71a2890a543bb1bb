#include "meshes/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "scenes/document.h"

namespace regather::scenes {

namespace {

struct Type {
    std::string_view names[2];
    std::size_t bytes;
    enum { whole_signed, whole_unsigned, real } kind;
};

constexpr std::array types{
    Type{{"char", "int8"}, 1, Type::whole_signed},   Type{{"uchar", "uint8"}, 1, Type::whole_unsigned},
    Type{{"short", "int16"}, 2, Type::whole_signed}, Type{{"ushort", "uint16"}, 2, Type::whole_unsigned},
    Type{{"int", "int32"}, 4, Type::whole_signed},   Type{{"uint", "uint32"}, 4, Type::whole_unsigned},
    Type{{"float", "float32"}, 4, Type::real},       Type{{"double", "float64"}, 8, Type::real}};

const Type* type_named(std::string_view name) {
    for (const Type& type : types)
        if (type.names[0] == name || type.names[1] == name) return &type;
    return nullptr;
}

struct Property {
    const Type* length = nullptr;  // Of a list; none for a single value.
    const Type* value = nullptr;
    bool names_vertices = false;
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

std::string_view next_word(std::string_view& text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    const auto end = std::find_if(text.begin(), text.end(), is_space);
    const std::string_view word = text.substr(0, static_cast<std::size_t>(end - text.begin()));
    text.remove_prefix(word.size());
    return word;
}

template <class Number>
std::optional<Number> number(std::string_view word) {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || word.empty()) return std::nullopt;
    return value;
}

enum class Form { ascii, little_endian, big_endian };

struct Header {
    Form form = Form::ascii;
    std::vector<Element> elements;
    std::string damage;
};

// Takes the header off `rest`.
Header read_header(std::string_view& rest) {
    Header header;
    const auto damaged = [&](std::string what) {
        header.damage = std::move(what);
        return header;
    };
    for (bool first = true, ended = false; !ended; first = false) {
        const std::size_t end = rest.find('\n');
        if (end == std::string_view::npos) return damaged("a header without its end");
        const std::string_view whole = rest.substr(0, end);
        std::string_view line = whole;
        rest.remove_prefix(end + 1);
        const std::string_view word = next_word(line);
        if (first != (word == "ply")) return damaged("no \"ply\" in the first line");
        if (first || word == "comment" || word == "obj_info") continue;
        bool good = true;
        if (word == "format") {
            const std::string_view form = next_word(line);
            good = form == "ascii" || form == "binary_little_endian" || form == "binary_big_endian";
            header.form = form == "ascii"                  ? Form::ascii
                          : form == "binary_little_endian" ? Form::little_endian
                                                           : Form::big_endian;
        } else if (word == "element") {
            Element element{std::string(next_word(line)), 0, {}};
            const auto count = number<std::uint64_t>(next_word(line));
            good = count.has_value();
            element.count = count.value_or(0);
            header.elements.push_back(std::move(element));
        } else if (word == "property" && !header.elements.empty()) {
            Property property;
            std::string_view type = next_word(line);
            if (type == "list") {
                property.length = type_named(next_word(line));
                good = property.length != nullptr && property.length->kind != Type::real;
                type = next_word(line);
            }
            property.value = type_named(type);
            const std::string_view name = next_word(line);
            good = good && property.value != nullptr && !name.empty();
            property.names_vertices = name == "vertex_indices" || name == "vertex_index";
            header.elements.back().properties.push_back(property);
        } else {
            ended = good = word == "end_header";
        }
        if (!good) return damaged("the header line " + in_quotes(whole));
    }
    for (const Element& element : header.elements)
        if (element.properties.empty())
            return damaged("the element " + in_quotes(element.name) + " without properties");
    return header;
}

// The next value of a body.
class Body {
public:
    Body(std::string_view bytes, Form form) : rest_(bytes), form_(form) {}

    std::optional<double> next(const Type& type) {
        if (form_ == Form::ascii) return number<double>(next_word(rest_));
        if (rest_.size() < type.bytes) return std::nullopt;
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < type.bytes; ++i) {
            const std::size_t place = form_ == Form::big_endian ? type.bytes - 1 - i : i;
            bits |= std::uint64_t{static_cast<unsigned char>(rest_[i])} << (8 * place);
        }
        rest_.remove_prefix(type.bytes);
        if (type.kind == Type::real)
            return type.bytes == 4 ? std::bit_cast<float>(static_cast<std::uint32_t>(bits))
                                   : std::bit_cast<double>(bits);
        const std::uint64_t sign = std::uint64_t{1} << (8 * type.bytes - 1);
        const double value = static_cast<double>(bits);
        return type.kind == Type::whole_signed && (bits & sign) != 0 ? value - 2 * static_cast<double>(sign)
                                                                     : value;
    }

private:
    std::string_view rest_;
    Form form_;
};

}  // namespace

std::string ply_damage(std::string_view bytes) {
    const Header header = read_header(bytes);
    if (!header.damage.empty()) return header.damage;
    double vertices = 0;
    for (const Element& element : header.elements)
        if (element.name == "vertex") vertices = static_cast<double>(element.count);

    Body body(bytes, header.form);
    for (const Element& element : header.elements)
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const Property& property : element.properties) {
                const auto where = [&] {
                    return fmt::format("{} {} of {}", element.name, i + 1, element.count);
                };
                double values = 1;
                if (property.length != nullptr) {
                    const std::optional<double> length = body.next(*property.length);
                    if (!length || !(*length >= 0) || *length != std::floor(*length))
                        return where() + " cut or without a list's length";
                    values = *length;
                }
                for (double v = 0; v < values; ++v) {
                    const std::optional<double> value = body.next(*property.value);
                    if (!value) return where() + " cut or not a number";
                    if (!std::isfinite(*value)) return where() + " with a number that is not finite";
                    if (property.names_vertices && !(*value >= 0 && *value < vertices))
                        return fmt::format("{} with vertex {} of {}", where(), *value, vertices);
                }
            }
    return "";
}

}  // namespace regather::scenes
