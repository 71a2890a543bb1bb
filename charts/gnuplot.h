// charts/gnuplot.h -- gnuplot as a child process: a script goes in, the bytes of a picture come out.
#pragma once
#include <string>
#include <string_view>

namespace regather::charts {

/// Runs `gnuplot` from PATH, without a shell and without the user's settings; the script must leave its
/// output on stdout. Throws std::runtime_error with one line when gnuplot is missing or the script fails.
std::string run_gnuplot(std::string_view script);

/// As a gnuplot string that shows `text`, whatever it holds: control characters become spaces and straight
/// apostrophes typographic ones.
std::string gnuplot_string(std::string_view text);

}  // namespace regather::charts
