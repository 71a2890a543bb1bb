#include "meshes/obj.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

#include "scenes/document.h"

namespace regather::scenes {

namespace {

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

std::string_view next_word(std::string_view& text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    std::size_t length = 0;
    while (length < text.size() && !is_space(text[length])) ++length;
    const std::string_view word = text.substr(0, length);
    text.remove_prefix(length);
    return word;
}

template <class Number>
std::optional<Number> number(std::string_view word) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || word.empty()) return std::nullopt;
    return value;
}

bool is_finite_number(std::string_view word) {
    const std::optional<double> value = number<double>(word);
    return value && std::isfinite(static_cast<float>(*value));
}

// Calls see(keyword, rest of the line, number of the line, line); stops when it returns words.
template <class See>
std::string each_line(std::string_view bytes, See see) {
    for (std::uint64_t at = 1; !bytes.empty(); ++at) {
        const std::size_t end = bytes.find('\n');
        const std::string_view line = bytes.substr(0, end);
        bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
        std::string_view rest = line;
        const std::string_view keyword = next_word(rest);
        if (keyword.empty() || keyword.front() == '#') continue;
        std::string what = see(keyword, rest);
        if (what.empty() && line.find('\0') != std::string_view::npos) what = "a NUL character";
        if (!what.empty()) return fmt::format("{} in line {}, {}", what, at, in_quotes(line));
    }
    return "";
}

using Counts = std::array<std::int64_t, 3>;  // Vertices, texture coordinates, normals.

// A corner "v", "v/t", "v//n" or "v/t/n". `before`: negative indices count back from there.
bool names_what_is_there(std::string_view corner, const Counts& before, const Counts& all) {
    for (std::size_t part = 0; part < 3; ++part) {
        const std::size_t slash = corner.find('/');
        const std::string_view word = corner.substr(0, slash);
        if (!word.empty() || part == 0) {
            const std::optional<std::int64_t> index = number<std::int64_t>(word);
            if (!index || *index == 0 || *index > all[part] || *index < -before[part]) return false;
        }
        if (slash == std::string_view::npos) return true;
        corner.remove_prefix(slash + 1);
    }
    return corner.empty();
}

void count(std::string_view keyword, Counts& counts) {
    if (keyword == "v") ++counts[0];
    if (keyword == "vt") ++counts[1];
    if (keyword == "vn") ++counts[2];
}

}  // namespace

ObjContents check_obj(std::string_view bytes) {
    ObjContents contents;
    Counts all{};
    each_line(bytes, [&](std::string_view keyword, std::string_view) {
        count(keyword, all);
        return std::string();
    });
    Counts before{};
    contents.damage = each_line(bytes, [&](std::string_view keyword, std::string_view rest) -> std::string {
        if (!rest.empty() && rest.find_last_not_of(" \t\r") != std::string_view::npos &&
            rest[rest.find_last_not_of(" \t\r")] == '\\')
            return "a line that goes on in the next";
        count(keyword, before);
        if (keyword == "v" || keyword == "vn") {
            for (int axis = 0; axis < 3; ++axis)
                if (!is_finite_number(next_word(rest))) return "a vertex without three finite numbers";
        } else if (keyword == "vt") {
            if (!is_finite_number(next_word(rest))) return "a texture coordinate without a finite number";
        } else if (keyword == "f" || keyword == "l" || keyword == "p") {
            for (std::string_view word = next_word(rest); !word.empty() && word.front() != '#';
                 word = next_word(rest))
                if (!names_what_is_there(word, before, all))
                    return fmt::format("the corner {} of {} vertices", in_quotes(word), all[0]);
        } else if (keyword == "mtllib") {
            while (!rest.empty() && is_space(rest.front())) rest.remove_prefix(1);
            while (!rest.empty() && is_space(rest.back())) rest.remove_suffix(1);
            if (!rest.empty()) contents.libraries.emplace_back(rest);
        }
        return "";
    });
    return contents;
}

std::string mtl_damage(std::string_view bytes) {
    bool in_material = false;
    return each_line(bytes, [&](std::string_view keyword, std::string_view rest) -> std::string {
        if (keyword == "newmtl") {
            in_material = true;
            return next_word(rest).empty() ? "a material without a name" : "";
        }
        if (!in_material) return "a term before the first newmtl";
        std::size_t numbers = 0;
        if (keyword == "Ka" || keyword == "Kd" || keyword == "Ks" || keyword == "Ke" || keyword == "Tf") {
            std::string_view first = rest;
            const std::string_view word = next_word(first);
            if (word == "spectral" || word == "xyz") return "a colour that is not three numbers";
            numbers = 3;
        } else if (keyword == "Ns" || keyword == "Ni" || keyword == "d" || keyword == "Tr" ||
                   keyword == "illum") {
            numbers = 1;
        }
        for (std::size_t i = 0; i < numbers; ++i)
            if (!is_finite_number(next_word(rest))) return "a term without its numbers";
        return "";
    });
}

}  // namespace regather::scenes
