#include "trace/word.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::trace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j < row.size(); ++j) {
            const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
        }
    }
    return row.back();
}

std::vector<std::string_view> nearest_words(std::string_view word, std::span<const std::string_view> words) {
    word = word.substr(0, 64);  // No known word is that long: the tail tells nothing.
    std::vector<std::string_view> best;
    std::size_t best_distance = 0;
    for (const std::string_view candidate : words) {
        const std::size_t distance = edit_distance(word, candidate);
        if (!best.empty() && distance > best_distance) continue;
        if (!best.empty() && distance < best_distance) best.clear();
        best_distance = distance;
        best.push_back(candidate);
    }
    return best;
}

std::string alternatives(std::span<const std::string_view> words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
        text += '"';
        text += words[i];
        text += '"';
    }
    return text;
}

std::string_view article(std::string_view word) {
    return !word.empty() && std::string_view("aeiouAEIOU").find(word[0]) != std::string_view::npos ? "an"
                                                                                                   : "a";
}

std::string listed(std::span<const std::string_view> words) {
    std::string text;
    for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string(word);
    return text;
}

NamedSpec named_spec(std::string_view what, std::string_view spec, std::span<const std::string_view> names) {
    const std::size_t colon = std::min(spec.find(':'), spec.size());
    const std::string_view name = spec.substr(0, colon);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        throw UsageError(fmt::format("{}: unknown {}; nearest: {}; known: {}", what, in_quotes(name),
                                     nearest_words(name, names).front(), listed(names)));
    return {static_cast<std::size_t>(found - names.begin()), spec.substr(std::min(colon + 1, spec.size()))};
}

}  // namespace regather::trace
