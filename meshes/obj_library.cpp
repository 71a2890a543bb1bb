#include "meshes/obj_library.h"

#include <algorithm>

namespace regather::meshes {

namespace {

constexpr std::string_view blanks = " \t\v\f";
constexpr std::size_t most_names = 1000;

bool ends_like_a_library(std::string_view word) {
    if (word.size() < 4) return false;
    std::string ending(word.substr(word.size() - 4));
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return ending == ".mtl";
}

std::vector<std::string_view> words_of(std::string_view text) {
    std::vector<std::string_view> words;
    while (true) {
        text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
        if (text.empty() || words.size() == most_names) return words;
        words.push_back(text.substr(0, text.find_first_of(blanks)));
        text.remove_prefix(words.back().size());
    }
}

// The text from the first to the last of the words.
std::string_view span_of(const std::vector<std::string_view>& words, std::size_t first, std::size_t last) {
    return {words[first].data(),
            static_cast<std::size_t>(words[last].data() + words[last].size() - words[first].data())};
}

class Names {
public:
    explicit Names(const Source& source) : source_(source) {}

    void add(std::string_view name) { names.emplace_back(there_as(name).value_or(std::string(name))); }
    bool add_if_there(std::string_view name) {
        if (!there_as(name)) return false;
        add(name);
        return true;
    }

    std::vector<std::string> names;

private:
    // The name under which there is such a file.
    std::optional<std::string> there_as(std::string_view name) const {
        std::string plain(name);
        if (source_.has_beside(plain)) return plain;
        if (plain.find('\\') == plain.npos) return std::nullopt;
        std::replace(plain.begin(), plain.end(), '\\', '/');
        if (source_.has_beside(plain)) return plain;
        return std::nullopt;
    }
    const Source& source_;
};

}  // namespace

std::vector<std::string> library_names(std::string_view text, const Source& source) {
    Names names(source);
    if (text.find('"') != text.npos) {
        while (true) {
            const std::size_t open = text.find('"');
            if (open == text.npos) break;
            for (const std::string_view word : words_of(text.substr(0, open))) names.add(word);
            const std::size_t close = text.find('"', open + 1);
            const std::string_view name =
                text.substr(open + 1, close == text.npos ? close : close - open - 1);
            if (!name.empty()) names.add(name);
            text = close == text.npos ? std::string_view() : text.substr(close + 1);
        }
        for (const std::string_view word : words_of(text)) names.add(word);
        return names.names;
    }
    if (text.empty() || names.add_if_there(text)) return names.names;
    const std::vector<std::string_view> words = words_of(text);
    for (std::size_t first = 0; first < words.size();) {
        std::size_t last = first;
        while (last + 1 < words.size() && !ends_like_a_library(words[last])) ++last;
        if (words[first].front() == '#' && !names.add_if_there(span_of(words, first, last))) break;
        const std::string_view whole = span_of(words, first, last);
        if (first == last ||
            !std::any_of(words.begin() + static_cast<std::ptrdiff_t>(first),
                         words.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                         [&](std::string_view word) { return source.has_beside(std::string(word)); })) {
            names.add(whole);
        } else if (!names.add_if_there(whole)) {
            for (std::size_t w = first; w <= last; ++w) names.add(words[w]);
        }
        first = last + 1;
    }
    return names.names;
}

}  // namespace regather::meshes
