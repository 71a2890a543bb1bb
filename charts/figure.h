// charts/figure.h -- a picture as a value: panels, lines, boxes, a legend. draw() lays it out and writes it
// as gnuplot commands; no chart writes any of its own. It knows pixels and dashes; nothing of what is
// measured.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "charts/scale.h"

namespace regather::charts {

/// A picture for gnuplot, without the kind of file.
struct Chart {
    std::string title, caption;
    unsigned width = 0, height = 0;  ///< [SVG pixels]; a PNG has twice as many.
    std::string commands;
    std::string skipped;  ///< Why there is nothing to draw; then all else is empty.
};

inline Chart skip(std::string reason) {
    Chart chart;
    chart.skipped = std::move(reason);
    return chart;
}

inline constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

struct Point {
    double x = 0, y = 0;
    std::string label = {};                    ///< Beside it.
    double low = no_number, high = no_number;  ///< Ends of its error bar; NaN: none.
    friend bool operator==(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }
};
/// Between two points that are not to be joined.
inline const Point gap{no_number, no_number};

struct Line {
    enum class Form {
        joined,
        steps,   ///< Level from each point to the next; the last one has no marker.
        plain,   ///< No markers.
        points,  ///< Markers alone.
        level,   ///< From edge to edge at the one point's height, dashed; markers at its ends.
        rule,    ///< Likewise, thin and without markers.
    };
    std::string label;  ///< In the legend; empty: not there.
    std::string colour;
    int marker = 0;
    int variant = 0;  ///< Picks the dashes.
    double width = 1.8;
    std::size_t every = 1;  ///< Only each `every`-th point gets a marker.
    Form form = Form::joined;
    std::vector<Point> points = {};
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

/// False colour by row, the first at the top; 0 is white.
struct Raster {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint64_t> values;
};

struct Axis {
    std::string label;  ///< With its unit.
    Scale scale;
};

struct Panel {
    Axis up;
    std::optional<Axis> across = {};  ///< None: the figure's.
    double height = 200;              ///< [SVG pixels]
    double share = 1;                 ///< Of the width, among the panels of a row.
    double room_beside = 0;           ///< Left empty at its right, in the shares of the row.
    bool beside = false;              ///< Right of the panel before, at its height, under its vertical axis.
    bool bare = false;                ///< No frame, no grid, no vertical axis; the label stands upright.
    double tick_size = 13;            ///< Of the vertical axis's labels [pixels].
    std::vector<Line> lines = {};
    std::vector<Box> boxes = {};
    std::vector<Note> notes = {};
    std::optional<Raster> raster = {};
    std::string remark = {};  ///< Above the panel.
};

/// Widths of the paper: of a column (3.3 inches), and of a page.
inline constexpr double column_width = 440, page_width = 980;

struct Figure {
    std::string title, caption;
    Axis across;
    std::vector<Panel> panels = {};
    double width = column_width;        ///< [SVG pixels]
    std::optional<Scale> colours = {};  ///< Of the rasters: a bar at the right; logarithmic.
};

/// One panel below the other (but for those `beside`), the legend under them. Texts are given the room that
/// they need: lines are wrapped, tick labels that would touch are left away.
Chart draw(const Figure& figure);

}  // namespace regather::charts
