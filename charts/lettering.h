// charts/lettering.h -- how much room a text takes in the charts' font, DejaVu Sans, and how it is cut into
// lines.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace regather::charts {

/// A text as a picture may hold it: one line of UTF-8. A control character is a blank; bytes that are no
/// UTF-8, and the two characters that XML 1.0 forbids beyond those (section 2.2), are U+FFFD.
std::string drawable(std::string_view text);

/// Width of a UTF-8 text at a font size [both in pixels]: the sum of the letters' advances; beyond ASCII, of
/// the widest letter that the charts use.
double text_width(std::string_view utf8, double font_size);

/// Cut into lines that are at most `width` wide, where there are places for it: at " · ", else at "; ", else
/// at a blank.
std::vector<std::string> wrapped(std::string_view text, double font_size, double width);

/// Cut to `width`, ending in "...".
std::string fitting(std::string_view text, double font_size, double width);

}  // namespace regather::charts
