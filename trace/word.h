// trace/word.h -- for messages about a word that nobody knows.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace regather::trace {

/// The words closest to `word` by edit distance (insertions, deletions, substitutions; Levenshtein 1966);
/// several when they tie, in their given order.
std::vector<std::string_view> nearest_words(std::string_view word, std::span<const std::string_view> words);

/// `"a"`, `"a" or "b"`, `"a", "b" or "c"`.
std::string alternatives(std::span<const std::string_view> words);

/// `a, b, c`.
std::string listed(std::span<const std::string_view> words);

}  // namespace regather::trace
