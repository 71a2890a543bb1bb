// trace/text.h -- text from a file or a command line, made fit to be shown in a message: one line, cut to a
// length, nothing in it that a terminal would obey.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace regather::trace {

/// `text` in double quotes, on one line: of more than `most_bytes` the first whole characters and "...".
/// Quotes and backslashes get a backslash; control characters (also the C1 ones, line separators and marks of
/// writing direction) become \u followed by four hexadecimal digits, or \n, \r, \t; bytes that are not UTF-8
/// become \x and two digits.
std::string in_quotes(std::string_view text, std::size_t most_bytes = 60);

}  // namespace regather::trace
