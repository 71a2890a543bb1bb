// tests/charts/svg_text.h -- the texts of an SVG that gnuplot wrote, with the room that each takes: measured
// in the font itself, not as the charts reckon.
#pragma once
#include <string>
#include <vector>

namespace regather::charts {

struct Text {
    std::string words;
    double left, top, right, bottom;  ///< Of its letters [SVG pixels].
};

/// Those that are not empty. Throws std::runtime_error for a picture that it does not understand.
std::vector<Text> texts_of(const std::string& svg);

/// A line for each pair of texts that overlap, each text that leaves the picture, and each marker of a curve
/// that lies on a text.
std::vector<std::string> collisions(const std::string& svg);

}  // namespace regather::charts
