#include "meshes/text_lines.h"

#include <fmt/format.h>

#include <algorithm>

#include "trace/error.h"

namespace regather::meshes {

namespace {

constexpr std::string_view blanks = " \t\v\f";
constexpr std::size_t most_keyword_bytes = 32;

std::string_view trimmed_left(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    return text;
}

std::string_view trimmed_right(std::string_view text) {
    const std::size_t last = text.find_last_not_of(blanks);
    return text.substr(0, last == text.npos ? 0 : last + 1);
}

std::string_view first_word(std::string_view& text) {
    text = trimmed_left(text);
    const std::string_view word = text.substr(0, text.find_first_of(blanks));
    text.remove_prefix(word.size());
    return word;
}

std::string in_lower_case(std::string_view word) {
    std::string lower(word.substr(0, most_keyword_bytes));
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

bool ends_with_a_name(std::string_view keyword) {
    return keyword == "usemtl" || keyword == "newmtl" || keyword == "mtllib" || keyword == "g" ||
           keyword == "o" || keyword.starts_with("map_") || keyword == "bump" || keyword == "disp" ||
           keyword == "decal" || keyword == "refl" || keyword == "norm";
}

// Cuts a comment behind the words.
std::string_view without_comment(std::string_view line) {
    for (std::size_t at = line.find('#'); at != line.npos; at = line.find('#', at + 1))
        if (at == 0 || blanks.find(line[at - 1]) != blanks.npos) return line.substr(0, at);
    return line;
}

}  // namespace

TextLines::TextLines(std::string_view bytes, std::string_view file) : left_(bytes), file_(file) {
    if (left_.starts_with("\xEF\xBB\xBF")) left_.remove_prefix(3);
    if (left_.find('\0') == left_.npos) return;
    while (physical_line().find('\0') == left_.npos) {
    }
    number_ = lines_;
    fail("a NUL character", "text");
}

std::string_view TextLines::physical_line() {
    std::size_t end = 0;
    while (end < left_.size() && left_[end] != '\n' && left_[end] != '\r') ++end;
    const std::string_view line = left_.substr(0, end);
    if (end < left_.size())
        end += left_[end] == '\r' && end + 1 < left_.size() && left_[end + 1] == '\n' ? 2 : 1;
    left_.remove_prefix(end);
    ++lines_;
    return line;
}

bool TextLines::next() {
    while (!left_.empty()) {
        std::string_view part = physical_line(), text = part;
        number_ = lines_;
        const std::string_view first = first_word(text);
        if (first.empty() || first.front() == '#') continue;
        keyword_ = in_lower_case(first);
        const bool has_comment = !ends_with_a_name(keyword_);
        const auto goes_on = [&] {
            part = trimmed_right(has_comment ? without_comment(part) : part);
            if (!part.ends_with('\\')) return false;
            part.remove_suffix(1);
            return true;
        };
        if (!goes_on()) {
            line_ = part;
        } else {
            joined_ = part;
            for (bool more = true; more && !left_.empty();) {
                part = physical_line();
                more = goes_on();
                joined_.append(1, ' ').append(part);
            }
            line_ = joined_;
        }
        // A keyword alone before the backslash has its words in the next line, and the backslash may touch
        // it.
        const std::string_view word = first_word(line_);
        if (word.empty()) continue;
        keyword_ = in_lower_case(word);
        return true;
    }
    return false;
}

std::string_view TextLines::rest() const {
    return trimmed_right(trimmed_left(line_));
}

std::string_view TextLines::word() {
    return first_word(line_);
}

void TextLines::fail(std::string_view found, std::string_view expected) const {
    throw trace::DataError(
        fmt::format("{}: line {}: found {}, expected {}", file_, number_, found, expected));
}

}  // namespace regather::meshes
