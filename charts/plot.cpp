#include "charts/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "charts/gnuplot.h"

namespace regather::charts {
namespace {

// All in SVG pixels.
constexpr double left = 94, top = 78, bottom = 54, between = 44, legend_line = 20, sample = 56, letter = 6.4;
constexpr double right = left + 470, single_height = 430, double_height = 270;

constexpr const char* solid_dashes[] = {"solid", "(6,3)", "(2,3)", "(10,3,2,3)"};
constexpr const char* floor_style = "lc rgb '#606060' lw 0.8 dt solid";
constexpr const char* level_dashes[] = {"(10,5)", "(4,4)", "(2,4)", "(12,4,2,4)"};

struct Value {
    double x, y, low, high;  // of several frames: median, least, most
    friend bool operator==(const Value&, const Value&) = default;
};

std::vector<const results::Row*> frames_at(const Curve& curve, std::size_t r) {
    return r < curve.frames.size() ? curve.frames[r] : std::vector<const results::Row*>{curve.rows[r]};
}

/// A curve as one panel shows it: places above 0 only, as a log axis has no 0.
std::vector<Value> values(const Curve& curve, const Panel& panel, Axis axis) {
    std::vector<Value> out;
    for (std::size_t r = 0; r < curve.rows.size(); ++r) {
        std::vector<double> found;
        for (const results::Row* row : frames_at(curve, r))
            if (const auto y = panel.measure(*row); y && *y > 0) found.push_back(*y);
        if (found.empty()) continue;
        std::sort(found.begin(), found.end());
        const std::size_t half = found.size() / 2;
        const double median = found.size() % 2 == 1 ? found[half] : (found[half - 1] + found[half]) / 2;
        out.push_back(
            {curve.flat ? 0 : axis_value(*curve.rows[r], axis), median, found.front(), found.back()});
    }
    return out;
}

bool all_zero(const Curve& curve, const Panel& panel) {
    return std::all_of(curve.rows.begin(), curve.rows.end(), [&](const results::Row* row) {
        return panel.measure(*row) == std::optional<double>(0);
    });
}

std::string ticks(std::span<const double> at, std::string (*label)(double)) {
    std::string out;
    for (const double value : at)
        out += fmt::format("{}{} {:.10g}", out.empty() ? "" : ", ", gnuplot_string(label(value)), value);
    return out;
}

std::size_t letters(std::string_view utf8) {
    return static_cast<std::size_t>(std::count_if(
        utf8.begin(), utf8.end(), [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

/// Curves from the top of the picture downwards, as they leave it at the right.
std::vector<std::size_t> legend_order(std::span<const Curve> curves, std::span<const Panel> panels,
                                      Axis axis) {
    std::vector<std::size_t> order;
    std::vector<double> height(curves.size());
    for (std::size_t c = 0; c < curves.size(); ++c) {
        for (auto panel = panels.rbegin(); panel != panels.rend(); ++panel)
            if (const auto shown = values(curves[c], *panel, axis); !shown.empty()) {
                // Curves that only a lower panel shows come after all of the first one's.
                const bool first = &*panel == &panels.front();
                height[c] = std::log(shown.back().y) + (first ? 1000 : 0);
                if (order.empty() || order.back() != c) order.push_back(c);
            }
    }
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return height[a] > height[b]; });
    return order;
}

/// `under`: how many curves with the same values are drawn over this one; it is wider by that, so that each
/// shows.
std::string line_style(const Curve& curve, int under) {
    const auto variant = static_cast<std::size_t>(curve.variant) % std::size(solid_dashes);
    const char* dashes = curve.flat ? level_dashes[variant] : solid_dashes[variant];
    const double wider = curve.flat ? 0 : std::min(under, 4);
    return fmt::format("lc rgb '{}' lw {:.2f} dt {} pt {} ps {:.2f}", curve.colour,
                       (curve.flat ? 1.3 : 1.8) + 1.3 * wider, dashes, curve.marker, 0.8 + 0.28 * wider);
}

struct Frame {
    double low_x, high_x;
    std::vector<double> x_ticks;
};

Frame frame_of(std::span<const Curve> curves, Axis axis) {
    Frame frame{};
    for (const Curve& curve : curves)
        for (const results::Row* row : curve.rows)
            if (!curve.flat) frame.x_ticks.push_back(axis_value(*row, axis));
    std::sort(frame.x_ticks.begin(), frame.x_ticks.end());
    frame.x_ticks.erase(std::unique(frame.x_ticks.begin(), frame.x_ticks.end()), frame.x_ticks.end());
    if (frame.x_ticks.empty()) return frame;
    // A margin of a fifteenth of the width, so that markers on level lines stand clear of the curves' ends.
    const double span = std::max(2.0, frame.x_ticks.back() / frame.x_ticks.front());
    const double margin = std::pow(span, 1.0 / 15);
    frame.low_x = frame.x_ticks.front() / margin;
    frame.high_x = frame.x_ticks.back() * margin;
    while (frame.x_ticks.size() > 14) {  // every second one, keeping the last
        std::vector<double> fewer;
        for (std::size_t i = frame.x_ticks.size(); i-- > 0;)
            if ((frame.x_ticks.size() - 1 - i) % 2 == 0) fewer.insert(fewer.begin(), frame.x_ticks[i]);
        frame.x_ticks = fewer;
    }
    return frame;
}

/// Writes the commands of one chart. Labels 1 to 5 are the title, the caption, a panel's note and the axes.
class Composer {
public:
    Composer(Chart& chart, std::span<const Curve> curves, const HorizontalAxis& axis,
             std::span<const Panel> panels)
        : chart_(chart),
          curves_(curves),
          axis_(axis),
          panels_(panels),
          order_(legend_order(curves, panels, axis.axis)),
          frame_(frame_of(curves, axis.axis)) {}

    bool compose() {
        if (order_.empty() || frame_.x_ticks.empty()) return false;
        size_canvas();
        say("set encoding utf8\n"
            "set multiplot\n"
            "set border 3 lc rgb '#404040'\n"
            "set tics nomirror out scale 0.6\n"
            "set grid xtics ytics lt 1 lc rgb '#e4e4e4' lw 0.6\n"
            "set logscale x 2\nset logscale y 10\nunset key\n"
            "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\n"
            "set xrange [{:.10g}:{:.10g}]\n",
            x_at(left), x_at(right), frame_.low_x, frame_.high_x);
        label(1, chart_.title, x_at(left), y_at(24), "left font ',15'");
        label(2, chart_.caption, x_at(left), y_at(46), "left font ',11' tc rgb '#505050'");
        double panel_top = top;
        for (std::size_t p = 0; p < panels_.size(); ++p) {
            panel(p, panel_top);
            panel_top += panel_height_ + between;
        }
        legend();
        say("unset multiplot\n");
        return true;
    }

private:
    template <class... Values>
    void say(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(chart_.commands), format, std::forward<Values>(values)...);
    }
    void label(int number, std::string_view text, double x, double y, std::string_view look) {
        say("set label {} {} at screen {:.5f},{:.5f} noenhanced {}\n", number, gnuplot_string(text), x, y,
            look);
    }
    double x_at(double pixels) const { return pixels / chart_.width; }
    double y_at(double pixels) const { return 1 - pixels / chart_.height; }

    void size_canvas() {
        std::size_t longest = 12;
        entries_ = order_.size();
        for (const std::size_t c : order_) longest = std::max(longest, letters(curves_[c].label));
        for (const Panel& panel : panels_) {
            if (!panel.floor) continue;
            longest = std::max(longest, letters(panel.floor_label));
            ++entries_;
        }
        panel_height_ = panels_.size() == 1 ? single_height : double_height;
        const auto panel_count = static_cast<double>(panels_.size());
        const double to_axis = top + panel_count * panel_height_ + (panel_count - 1) * between + bottom;
        const double to_legend = top + legend_line * static_cast<double>(entries_);
        const double beside = right + sample + letter * static_cast<double>(longest) + 24;
        const double caption = left + letter * static_cast<double>(letters(chart_.caption)) + 8;
        chart_.width = static_cast<unsigned>(std::ceil(std::max(beside, caption)));
        chart_.height = static_cast<unsigned>(std::ceil(std::max(to_axis, to_legend)));
    }

    void vertical_range(const Panel& panel) {
        double low = panel.floor.value_or(1e300), high = panel.floor.value_or(0);
        for (const std::size_t c : order_)
            for (const Value value : values(curves_[c], panel, axis_.axis)) {
                low = std::min(low, value.low);
                high = std::max(high, value.high);
            }
        if (high == 0) low = high = 1;
        low *= 0.75;
        high *= 1.3;
        auto at = log_ticks(low, high);
        std::erase_if(at, [&](double tick) { return tick < low || tick > high; });
        say("set yrange [{:.10g}:{:.10g}]\nset ytics ({})\n", low, high, ticks(at, panel.tick_label));
    }

    void panel(std::size_t p, double panel_top) {
        const Panel& panel = panels_[p];
        const bool is_last = p + 1 == panels_.size();
        say("set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n", y_at(panel_top),
            y_at(panel_top + panel_height_));
        vertical_range(panel);
        label(4, panel.label, x_at(12), y_at(panel_top + panel_height_ / 2), "center rotate by 90");
        std::string zeros;
        for (const Curve& curve : curves_)
            if (all_zero(curve, panel)) zeros += (zeros.empty() ? "" : "; ") + curve.label;
        if (!zeros.empty())
            label(3, panel.nothing + ": " + zeros, x_at(left), y_at(panel_top - 9),
                  "left font ',10' tc rgb '#505050'");
        if (is_last)  // a label, as the SVG terminal drops an xlabel that it thinks too low
            label(5, axis_.label, x_at((left + right) / 2), y_at(panel_top + panel_height_ + 44), "center");
        say("set xtics ({})\n", is_last ? ticks(frame_.x_ticks, axis_.tick_label)
                                        : ticks(frame_.x_ticks, [](double) { return std::string(); }));
        plot(p);
        say("unset label\n");
    }

    void plot(std::size_t p) {
        const Panel& panel = panels_[p];
        std::string plots;
        for (std::size_t i = 0; i < order_.size(); ++i) {
            const Curve& curve = curves_[order_[i]];
            const auto shown = values(curve, panel, axis_.axis);
            if (shown.empty()) continue;
            const auto same = [&](std::size_t j) {
                const Curve& other = curves_[order_[j]];
                return other.flat == curve.flat && values(other, panel, axis_.axis) == shown;
            };
            int under = 0, over = 0;
            for (std::size_t j = 0; j < order_.size(); ++j)
                if (j != i && same(j)) ++(j < i ? over : under);
            say("# {}\n$curve_{}_{} << EOD\n", gnuplot_string(curve.label), p, i);
            // Level lines of the same height: each is a marker shorter than the one it lies on, so that each
            // shows.
            const double inset = std::pow(frame_.high_x / frame_.low_x, 0.028 * std::min(over, 8));
            for (const Value value : shown) {
                if (curve.flat)
                    say("{0:.10g} {2:.10g}\n{1:.10g} {2:.10g}\n", frame_.low_x * inset, frame_.high_x / inset,
                        value.y);
                else
                    say("{:.10g} {:.10g}\n", value.x, value.y);
            }
            say("EOD\n");
            bars(curve, shown, fmt::format("$bars_{}_{}", p, i), plots);
            plots += fmt::format("{}$curve_{}_{} using 1:2 with linespoints {} title {}",
                                 plots.empty() ? "" : ", \\\n    ", p, i, line_style(curve, under),
                                 gnuplot_string(curve.label));
        }
        if (panel.floor)
            plots += fmt::format("{}{:.10g} with lines {} title {}", plots.empty() ? "" : ", \\\n    ",
                                 *panel.floor, floor_style, gnuplot_string(panel.floor_label));
        say("plot {}\n", plots.empty() ? "-1" : plots);  // an empty frame: -1 is below any log axis
    }

    void bars(const Curve& curve, std::span<const Value> shown, const std::string& name, std::string& plots) {
        if (std::none_of(shown.begin(), shown.end(), [](const Value& v) { return v.low < v.high; })) return;
        say("{} << EOD\n", name);
        for (const Value& value : shown) {
            if (curve.flat)  // at its outermost markers
                for (const double x : {frame_.low_x, frame_.high_x})
                    say("{:.10g} {:.10g} {:.10g} {:.10g}\n", x, value.y, value.low, value.high);
            else
                say("{:.10g} {:.10g} {:.10g} {:.10g}\n", value.x, value.y, value.low, value.high);
        }
        say("EOD\n");
        plots += fmt::format("{}{} using 1:2:3:4 with yerrorbars lc rgb '{}' lw 1.2 dt solid pt 0 notitle",
                             plots.empty() ? "" : ", \\\n    ", name, curve.colour);
    }

    /// A plot of its own over the whole height, as gnuplot drops entries that do not fit beside their plot.
    void legend() {
        say("unset border\nunset tics\nunset grid\nunset logscale\n"
            "set tmargin at screen 1\nset bmargin at screen 0\nset xrange [0:1]\nset yrange [0:1]\n"
            "set key at screen {:.5f},{:.5f} left top vertical maxrows {} Left reverse noenhanced "
            "samplen 3 spacing 1.25 font ',11'\n"
            "plot -1 notitle",
            x_at(right + 6), y_at(top - 8), entries_);
        for (const std::size_t c : order_)
            say(", \\\n    keyentry with linespoints {} title {}", line_style(curves_[c], 0),
                gnuplot_string(curves_[c].label));
        for (const Panel& panel : panels_)
            if (panel.floor)
                say(", \\\n    keyentry with lines {} title {}", floor_style,
                    gnuplot_string(panel.floor_label));
        say("\n");
    }

    Chart& chart_;
    std::span<const Curve> curves_;
    const HorizontalAxis& axis_;
    std::span<const Panel> panels_;
    std::vector<std::size_t> order_;
    Frame frame_;
    std::size_t entries_ = 0;
    double panel_height_ = 0;
};

}  // namespace

std::vector<double> log_ticks(double low, double high) {
    const int first = static_cast<int>(std::floor(std::log10(low)));
    const int last = static_cast<int>(std::ceil(std::log10(high)));
    std::vector<double> all;
    for (int decade = first; decade <= last; ++decade)
        for (const int digit : {1, 2, 5})
            if (digit == 1 || high / low < 200) all.push_back(digit * std::pow(10.0, decade));
    // From the last one at or below `low` to the first at or above `high`.
    const double slack = 1e-9;
    while (all.size() > 2 && all[1] <= low * (1 + slack)) all.erase(all.begin());
    while (all.size() > 2 && all[all.size() - 2] >= high * (1 - slack)) all.pop_back();
    return all;
}

bool compose_panels(Chart& chart, std::span<const Curve> curves, const HorizontalAxis& axis,
                    std::span<const Panel> panels) {
    return Composer(chart, curves, axis, panels).compose();
}

}  // namespace regather::charts
