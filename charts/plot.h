// charts/plot.h -- curves on log axes as gnuplot commands: panels one above the other, one legend at their
// right. Knows pixels, ticks and dashes; nothing of what is measured.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "charts/chart.h"
#include "charts/series.h"

namespace regather::charts {

/// One measure of the curves, drawn against the common axis: of rows of several frames the median, with a bar
/// from the least to the most.
struct Panel {
    std::string label;  ///< Of the vertical axis, with its unit.
    std::function<std::optional<double>(const results::Row&)> measure;
    std::string (*tick_label)(double);
    std::optional<double> floor;  ///< A thin level line ...
    std::string floor_label;      ///< ... and what it is.
    std::string nothing;          ///< Before the names of curves that are all 0.
};

struct HorizontalAxis {
    std::string label;
    Axis axis;
    std::string (*tick_label)(double);
};

/// Fills width, height and commands from title and caption. The legend lists curves from top to bottom of the
/// first panel. False when no panel has anything above 0.
bool compose_panels(Chart& chart, std::span<const Curve> curves, const HorizontalAxis& axis,
                    std::span<const Panel> panels);

/// Round values from at most `low` to at least `high`: 1, 2, 5 a decade, or whole decades when they are many.
std::vector<double> log_ticks(double low, double high);

}  // namespace regather::charts
