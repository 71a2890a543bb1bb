// trace/text.h -- text of a file or of a command line as a message may show it: one line of bounded length,
// whatever the bytes are.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace regather::trace {

/// The length in bytes of the character that opens `text`, 1 to 4; 0 when the text is empty or does not open
/// with well-formed UTF-8 (Unicode 15, table 3-7: no surrogates, no overlong forms, nothing above U+10FFFF).
std::size_t utf8_length(std::string_view text);

/// `text` on one line: its first `most_bytes` (cut between characters, then "..."). Control characters and
/// bytes that are no UTF-8 become \n, \t, \r or \x1b; what a terminal would not show (C1 controls, line and
/// paragraph separators, marks of writing direction) becomes \u{202e}.
std::string shown(std::string_view text, std::size_t most_bytes = 60);

inline constexpr std::size_t most_shown_path = 300;  ///< Of a path, which is worth more than a text.

/// shown() in double quotes; quotes and backslashes of the text are escaped.
std::string in_quotes(std::string_view text, std::size_t most_bytes = 60);

}  // namespace regather::trace
