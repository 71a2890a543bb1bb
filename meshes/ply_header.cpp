#include "meshes/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::meshes {

using trace::in_quotes;

namespace {

constexpr std::array types{PlyType{"char", "int8", 1, PlyType::whole_signed},
                           PlyType{"uchar", "uint8", 1, PlyType::whole_unsigned},
                           PlyType{"short", "int16", 2, PlyType::whole_signed},
                           PlyType{"ushort", "uint16", 2, PlyType::whole_unsigned},
                           PlyType{"int", "int32", 4, PlyType::whole_signed},
                           PlyType{"uint", "uint32", 4, PlyType::whole_unsigned},
                           PlyType{"float", "float32", 4, PlyType::real},
                           PlyType{"double", "float64", 8, PlyType::real}};
constexpr std::string_view type_names = "char, uchar, short, ushort, int, uint, float or double";
constexpr std::size_t most_members = 1000;  // Of elements, and of properties of one.

std::string_view next_word(std::string_view& line) {
    constexpr std::string_view blanks = " \t\r\v\f";
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(blanks));
    line.remove_prefix(word.size());
    return word;
}

class Header {
public:
    Header(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

    PlyHeader read() {
        const std::size_t end = bytes_.find_first_of("\r\n");
        std::string_view first = bytes_.substr(0, std::min<std::size_t>(end, 100));
        at_ = first.starts_with("\xEF\xBB\xBF") ? 3 : 0;
        first.remove_prefix(at_);
        if (end == bytes_.npos || next_word(first) != "ply" || !next_word(first).empty())
            fail("no \"ply\" in the first line", "a PLY file");
        ending_ = bytes_[end] == '\r' && bytes_.substr(end, 2) != "\r\n" ? '\r' : '\n';
        while (next_line()) {
            const std::string_view word = next_word(line_);
            if (word == "end_header") {
                if (!has_form_) fail("a header without its format", "a line \"format FORM 1.0\" in it");
                header_.body = at_;
                header_.body_line = number_ + 1;
                return std::move(header_);
            }
            read_line(word);
        }
        fail("the end of the file", "end_header");
    }

private:
    [[noreturn]] void fail(std::string_view found, std::string_view expected) const {
        throw trace::DataError(fmt::format("{}: line {}: found {}, expected {}", file_,
                                           std::max<std::uint64_t>(number_, 1), found, expected));
    }

    bool next_line() {
        const std::size_t end = bytes_.find(ending_, at_);
        if (end == bytes_.npos) return false;
        whole_ = line_ = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        ++number_;
        return true;
    }

    void read_line(std::string_view word) {
        if (word == "comment" || word == "obj_info") {
            if (next_word(line_) == "TextureFile") ++header_.textures;
        } else if (word == "format") {
            read_format();
        } else if (word == "element") {
            read_element();
        } else if (word == "property") {
            read_property();
        } else if (word != "ply" || number_ > 1) {
            if (!word.empty())
                fail(in_quotes(whole_), "format, element, property, comment, obj_info or end_header");
        }
    }

    void must_end() {
        if (const std::string_view more = next_word(line_); !more.empty())
            fail(fmt::format("{} at the end of {}", in_quotes(more), in_quotes(whole_)), "nothing more");
    }

    void read_format() {
        const std::string_view form = next_word(line_), version = next_word(line_);
        if (has_form_) fail("a second format", "one");
        has_form_ = true;
        if (form == "binary_little_endian")
            header_.form = PlyForm::little_endian;
        else if (form == "binary_big_endian")
            header_.form = PlyForm::big_endian;
        else if (form != "ascii")
            fail("the format " + in_quotes(form), "ascii, binary_little_endian or binary_big_endian");
        if (version != "1.0") fail("the version " + in_quotes(version), "1.0");
        must_end();
    }

    void read_element() {
        PlyElement element{std::string(next_word(line_)), 0, {}};
        const std::string_view count = next_word(line_);
        const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (element.name.empty() || count.empty() || error != std::errc{} ||
            end != count.data() + count.size())
            fail(in_quotes(whole_), "element NAME COUNT");
        must_end();
        for (const PlyElement& other : header_.elements)
            if (other.name == element.name) fail("a second element " + in_quotes(element.name), "one");
        if (header_.elements.size() == most_members)
            fail(fmt::format("more than {} elements", most_members), "at most as many");
        header_.elements.push_back(std::move(element));
    }

    const PlyType* type() {
        const std::string_view name = next_word(line_);
        const auto found = std::find_if(types.begin(), types.end(), [&](const PlyType& t) {
            return t.name == name || t.other_name == name;
        });
        if (found == types.end()) fail(fmt::format("the type {}", in_quotes(name)), type_names);
        return &*found;
    }

    void read_property() {
        if (header_.elements.empty()) fail("a property before the first element", "an element");
        PlyProperty property;
        std::string_view ahead = line_;
        if (next_word(ahead) == "list") {
            line_ = ahead;
            property.length = type();
            if (property.length->kind == PlyType::real)
                fail(fmt::format("a list whose length is a {}", property.length->name), "a whole type");
        }
        property.value = type();
        property.name = next_word(line_);
        if (property.name.empty()) fail(in_quotes(whole_), "a name behind the type");
        must_end();
        std::vector<PlyProperty>& properties = header_.elements.back().properties;
        for (const PlyProperty& other : properties)
            if (other.name == property.name)
                fail("a second property " + in_quotes(property.name), "one in an element");
        if (properties.size() == most_members)
            fail(fmt::format("more than {} properties of an element", most_members), "at most as many");
        properties.push_back(std::move(property));
    }

    std::string_view bytes_;
    const std::string& file_;
    PlyHeader header_;
    std::string_view line_, whole_;
    std::size_t at_ = 0;
    std::uint64_t number_ = 0;
    char ending_ = '\n';
    bool has_form_ = false;
};

}  // namespace

PlyHeader read_ply_header(std::string_view bytes, const std::string& file) {
    return Header(bytes, file).read();
}

}  // namespace regather::meshes
