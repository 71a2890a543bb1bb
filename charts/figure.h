// charts/figure.h -- panels one above the other over a common axis, as gnuplot commands, for a column of a
// paper (3.3 inches): legend below, labels at points, boxes. Knows pixels and dashes; nothing of what is
// measured.
#pragma once
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "charts/chart.h"
#include "charts/series.h"

namespace regather::charts {

struct Point {
    double x = 0, y = 0;
    std::string label = {};                                             ///< Beside it.
    double low = std::numeric_limits<double>::quiet_NaN(), high = low;  ///< Ends of its error bar; NaN: none.
    friend bool operator==(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }
};
/// Between two points that are not to be joined.
inline const Point gap{
    std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(), {}};  // no bar

struct Line {
    /// `plain`: no markers. `steps`: level from each point to the next; the last one has no marker.
    enum class Form { joined, steps, plain };
    std::string label;  ///< In the legend; empty: not there.
    std::string colour;
    int marker = 0;
    int variant = 0;  ///< Picks the dashes.
    double width = 1.8;
    std::size_t every = 1;  ///< Only each `every`-th point gets a marker.
    Form form = Form::joined;
    std::vector<Point> points;
};

struct Box {
    double left, right, bottom, top;  ///< In the units of the axes.
    std::string label;                ///< In the legend: the first box of a label; empty: not there.
    std::string colour;
    std::string text = {}, text_colour = "#ffffff";  ///< Inside; left away where it does not fit.
};

struct Note {
    double x, y;
    std::string text;
    bool at_right = false;  ///< Ends at x instead of beginning there.
};

struct Scale {
    bool log = false;
    double low = 0, high = 1;
    std::vector<std::pair<double, std::string>> ticks = {};
};

struct Plate {
    std::string label;    ///< Of the vertical axis, with its unit.
    double height = 200;  ///< [SVG pixels]
    Scale vertical;
    std::vector<Line> lines = {};
    std::vector<Box> boxes = {};
    std::vector<Note> notes = {};
    std::string remark = {};  ///< Above the panel.
    bool bare = false;        ///< No frame, no grid, no vertical axis; the label stands upright.
};

struct Figure {
    std::string label;  ///< Of the horizontal axis, with its unit.
    Scale horizontal;
    std::vector<Plate> plates;
    double margin = 70;  ///< For the labels of the vertical axes [SVG pixels].
};

/// Fills width, height and commands from title, caption and figure.
void compose(Chart& chart, const Figure& figure);

/// A line in a curve's look, without points.
Line line_of(const Curve& curve);

/// Encloses `values` with a margin; ticks at 1, 2, 5 or whole decades. Values must be above 0.
Scale log_scale(std::span<const double> values, std::string (*label)(double));
/// From 0 to a round number at or above `high`; four to six ticks.
Scale linear_scale(double high, std::string (*label)(double));

std::string plain_number(double value);  ///< "0.002", "36"
std::string byte_number(double bytes);   ///< "100 MB"

}  // namespace regather::charts
