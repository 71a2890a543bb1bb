// trace/word.h -- for messages about a word that nobody knows.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace regather::trace {

/// Insertions, deletions and substitutions of bytes that make `b` of `a` (Levenshtein 1966).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The words closest to `word` by edit distance; several when they tie, in their given order.
std::vector<std::string_view> nearest_words(std::string_view word, std::span<const std::string_view> words);

/// `"a"`, `"a" or "b"`, `"a", "b" or "c"`.
std::string alternatives(std::span<const std::string_view> words);

/// "an" before a vowel, "a" before all else: by letter, so not for "hour" or "unit".
std::string_view article(std::string_view word);

/// `a, b, c`.
std::string listed(std::span<const std::string_view> words);

/// A spec, NAME or NAME:PARAMETERS.
struct NamedSpec {
    std::size_t which;            ///< Of the names.
    std::string_view parameters;  ///< Behind the colon; of the spec's text.
};
/// Throws UsageError for another name than `names` (of a `what`: "structure"), names the nearest and lists
/// all.
NamedSpec named_spec(std::string_view what, std::string_view spec, std::span<const std::string_view> names);
/// Of the names of a table's rows.
template <class Row>
NamedSpec named_spec(std::string_view what, std::string_view spec, std::span<const Row> table) {
    std::vector<std::string_view> names;
    for (const Row& row : table) names.push_back(row.name);
    return named_spec(what, spec, std::span<const std::string_view>(names));
}

}  // namespace regather::trace
