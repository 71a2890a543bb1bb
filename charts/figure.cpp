#include "charts/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "charts/gnuplot.h"
#include "charts/plot.h"

namespace regather::charts {
namespace {

// All in SVG pixels.
constexpr double width = 440, right = 424, edge = 10, title_at = 22, caption_at = 42, caption_line = 15;
constexpr double above = 18, remark_line = 16, between = 22, axis_room = 58, legend_line = 18, sample = 30,
                 gap_to_text = 11;
constexpr double small_letter = 6.3, tiny_letter = 5.9;
constexpr const char* dashes[] = {"solid", "(6,3)", "(2,3)", "(10,3,2,3)"};

std::size_t letters(std::string_view utf8) {
    return static_cast<std::size_t>(std::count_if(
        utf8.begin(), utf8.end(), [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

/// Cut at " · " into lines of at most `most` letters, where that is possible.
std::vector<std::string> wrapped(const std::string& text, std::size_t most) {
    constexpr std::string_view dot = " · ";
    std::vector<std::string> out;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(dot, at), text.size());
        const std::string part = text.substr(at, end - at);
        if (!out.empty() && letters(out.back()) + letters(dot) + letters(part) <= most)
            out.back() += std::string(dot) + part;
        else
            out.push_back(part);
        at = end + dot.size();
    }
    return out;
}

/// What the legend shows: a line's look or a box's colour.
struct Key {
    std::string label;
    const Line* line = nullptr;
    std::string colour = {};
};

std::vector<Key> keys_of(const Figure& figure) {
    std::vector<Key> keys;
    const auto add = [&](Key key) {
        const bool known =
            std::any_of(keys.begin(), keys.end(), [&](const Key& k) { return k.label == key.label; });
        if (!key.label.empty() && !known) keys.push_back(std::move(key));
    };
    for (const Plate& plate : figure.plates) {
        for (const Box& box : plate.boxes) add({box.label, nullptr, box.colour});
        for (const Line& line : plate.lines) add({line.label, &line});
    }
    return keys;
}

std::string look(const Line& line) {
    const auto variant = static_cast<std::size_t>(line.variant) % std::size(dashes);
    const std::string stroke =
        fmt::format("lc rgb '{}' lw {:.2f} dt {}", line.colour, line.width, dashes[variant]);
    return line.form == Line::Form::plain
               ? "with lines " + stroke
               : fmt::format("with linespoints {} pt {} ps 0.8 pi {}", stroke, line.marker, line.every);
}

std::string key_look(Line line) {
    line.every = 1;
    return look(line);
}

class Drawing {
public:
    Drawing(Chart& chart, const Figure& figure)
        : chart_(chart),
          figure_(figure),
          caption_(wrapped(chart.caption, static_cast<std::size_t>((width - 2 * edge) / tiny_letter))),
          keys_(keys_of(figure)) {}

    void compose() {
        size_canvas();
        say("set encoding utf8\nset multiplot\nset border 3 lc rgb '#404040'\n"
            "set tics nomirror out scale 0.6\nset grid xtics ytics lt 1 lc rgb '#e4e4e4' lw 0.6\nunset key\n"
            "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\n",
            x_at(left()), x_at(right));
        label(chart_.title, edge, title_at, "left font ',15'");
        for (std::size_t i = 0; i < caption_.size(); ++i)
            label(caption_[i], edge, caption_at + caption_line * static_cast<double>(i),
                  "left font ',11' tc rgb '#505050'");
        scale('x', figure_.horizontal);
        double plate_top = top();
        for (std::size_t p = 0; p < figure_.plates.size(); ++p) {
            const Plate& plate = figure_.plates[p];
            plate_top += plate.remark.empty() ? 0 : remark_line;
            draw(plate, p, plate_top);
            plate_top += plate.height + between;
        }
        legend(plate_top - between + axis_room);
        say("unset multiplot\n");
    }

private:
    template <class... Values>
    void say(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(chart_.commands), format, std::forward<Values>(values)...);
    }
    void label(std::string_view text, double x, double y, std::string_view style) {
        say("set label {} at screen {:.5f},{:.5f} noenhanced {}\n", gnuplot_string(text), x_at(x), y_at(y),
            style);
    }
    double x_at(double pixels) const { return pixels / chart_.width; }
    double y_at(double pixels) const { return 1 - pixels / chart_.height; }
    double left() const { return figure_.margin; }
    double top() const {
        return caption_at + caption_line * static_cast<double>(caption_.size()) - 8 + above;
    }

    void size_canvas() {
        double longest = 0;
        for (const Key& key : keys_) longest = std::max(longest, static_cast<double>(letters(key.label)));
        key_width_ = sample + gap_to_text + longest * small_letter + 10;
        columns_ = static_cast<std::size_t>(std::clamp((width - 2 * edge) / key_width_, 1.0, 3.0));
        columns_ = std::max<std::size_t>(1, std::min(columns_, keys_.size()));
        key_width_ = (width - 2 * edge) / static_cast<double>(columns_);
        lines_ = (keys_.size() + columns_ - 1) / columns_;
        double height = top() + axis_room + legend_line * static_cast<double>(lines_) + 6;
        for (const Plate& plate : figure_.plates)
            height += plate.height + (plate.remark.empty() ? 0 : remark_line);
        height += between * static_cast<double>(figure_.plates.size() - 1);
        chart_.width = static_cast<unsigned>(width);
        chart_.height = static_cast<unsigned>(std::ceil(height));
    }

    void scale(char axis, const Scale& scale) {
        say("{}set logscale {}\nset {}range [{:.10g}:{:.10g}]\n", scale.log ? "" : "un", axis, axis,
            scale.low, scale.high);
    }
    void ticks(char axis, const Scale& scale, bool labelled) {
        say("set {}tics nomirror out scale 0.6 (", axis);
        for (std::size_t i = 0; i < scale.ticks.size(); ++i)
            say("{}{} {:.10g}", i == 0 ? "" : ", ", gnuplot_string(labelled ? scale.ticks[i].second : ""),
                scale.ticks[i].first);
        say(")\n");
    }
    /// How many pixels a span of the horizontal axis takes.
    double pixels(double from, double to) const {
        const Scale& x = figure_.horizontal;
        const double share =
            x.log ? std::log(to / from) / std::log(x.high / x.low) : (to - from) / (x.high - x.low);
        return share * (right - left());
    }

    void draw(const Plate& plate, std::size_t p, double plate_top) {
        const bool is_last = p + 1 == figure_.plates.size();
        say("set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n", y_at(plate_top),
            y_at(plate_top + plate.height));
        scale('y', plate.vertical);
        if (plate.bare) {
            say("unset border\nunset grid\nunset xtics\nunset ytics\n");
            if (is_last) ticks('x', figure_.horizontal, true);
            label(plate.label, left() - 8, plate_top + plate.height / 2, "right");
        } else {
            say("set border 3 lc rgb '#404040'\nset grid xtics ytics lt 1 lc rgb '#e4e4e4' lw 0.6\n");
            ticks('x', figure_.horizontal, is_last);
            ticks('y', plate.vertical, true);
            label(plate.label, 12, plate_top + plate.height / 2, "center rotate by 90");
        }
        if (!plate.remark.empty())
            label(plate.remark, edge, plate_top - 10, "left font ',11' tc rgb '#505050'");
        if (is_last) label(figure_.label, (left() + right) / 2, plate_top + plate.height + 43, "center");
        for (const Note& note : plate.notes)
            say("set label {} at {:.10g},{:.10g} {} noenhanced font ',11'\n", gnuplot_string(note.text),
                note.x, note.y, note.at_right ? "right" : "left");
        data(plate, p);
        say("unset label\n");
    }

    void data(const Plate& plate, std::size_t p) {
        std::string plots;
        const auto add = [&](const std::string& plot) {
            plots += (plots.empty() ? "" : ", \\\n    ") + plot;
        };
        for (std::size_t b = 0; b < plate.boxes.size(); ++b) {
            const Box& box = plate.boxes[b];
            say("# {}\n$box_{}_{} << EOD\n{:.10g} {:.10g} {:.10g} {:.10g}\nEOD\n", gnuplot_string(box.label),
                p, b, box.left, box.right, box.bottom, box.top);
            add(fmt::format("$box_{}_{} using 1:3:1:2:3:4 with boxxyerror fs solid 1 noborder lc rgb '{}'", p,
                            b, box.colour));
            if (box.text.empty() ||
                pixels(box.left, box.right) < small_letter * static_cast<double>(letters(box.text)) + 4)
                continue;
            const double middle =
                figure_.horizontal.log ? std::sqrt(box.left * box.right) : (box.left + box.right) / 2;
            say("set label {} at {:.10g},{:.10g} center noenhanced font ',11' tc rgb '{}' front\n",
                gnuplot_string(box.text), middle, (box.bottom + box.top) / 2, box.text_colour);
        }
        for (std::size_t l = 0; l < plate.lines.size(); ++l) {
            Line line = plate.lines[l];
            if (line.points.empty()) continue;
            // Curves that coincide: each is wider than the one drawn over it, so that each shows.
            for (std::size_t over = l + 1; over < plate.lines.size(); ++over)
                line.width += plate.lines[over].points == line.points ? 1.4 : 0;
            const std::string name = fmt::format("$line_{}_{}", p, l);
            say("# {}\n{} << EOD\n", gnuplot_string(line.label), name);
            for (const Point& point : line.points) {
                if (std::isnan(point.x))
                    say("\n");
                else
                    say("{:.10g} {:.10g}\n", point.x, point.y);
                if (!point.label.empty())
                    labels_ += fmt::format(
                        "set label {} at {:.10g},{:.10g} noenhanced font ',10' tc rgb '{}' left offset "
                        "0.5,0.45\n",
                        gnuplot_string(point.label), point.x, point.y, line.colour);
            }
            say("EOD\n");
            bars(line, fmt::format("$bars_{}_{}", p, l), add);
            if (line.form == Line::Form::steps) {
                add(fmt::format("{} using 1:2 with steps lc rgb '{}' lw {:.2f}", name, line.colour,
                                line.width));
                // The last point only carries the last step to the edge.
                add(fmt::format("{} every ::0::{} using 1:2 with points lc rgb '{}' pt {} ps 0.7", name,
                                line.points.size() - 2, line.colour, line.marker));
            } else {
                add(fmt::format("{} using 1:2 {}", name, look(line)));
            }
        }
        say("{}plot {}\n", labels_, plots.empty() ? "NaN" : plots);
        labels_.clear();
    }

    template <class Add>
    void bars(const Line& line, const std::string& name, const Add& add) {
        const auto has_bar = [](const Point& point) { return !std::isnan(point.low); };
        if (std::none_of(line.points.begin(), line.points.end(), has_bar)) return;
        say("{} << EOD\n", name);
        for (const Point& point : line.points)
            if (has_bar(point))
                say("{:.10g} {:.10g} {:.10g} {:.10g}\n", point.x, point.y, point.low, point.high);
        say("EOD\n");
        add(fmt::format("{} using 1:2:3:4 with yerrorbars lc rgb '{}' lw 1 dt solid pt 0", name,
                        line.colour));
    }

    /// A plot of its own over the whole canvas in pixels, as gnuplot drops entries that do not fit beside
    /// their plot.
    void legend(double legend_top) {
        if (keys_.empty()) return;
        say("unset border\nunset tics\nunset grid\nunset logscale\n"
            "set lmargin at screen 0\nset rmargin at screen 1\nset tmargin at screen 1\nset bmargin at "
            "screen 0\n"
            "set xrange [0:{}]\nset yrange [{}:0]\n",
            chart_.width, chart_.height);
        std::string plots;
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            const double x = edge + key_width_ * static_cast<double>(k / lines_);
            const double y = legend_top + legend_line * (static_cast<double>(k % lines_) + 0.5);
            label(keys_[k].label, x + sample + gap_to_text, y, "left font ',12'");
            if (keys_[k].line != nullptr) {
                say("$key_{} << EOD\n{:.2f} {:.2f}\n{:.2f} {:.2f}\n{:.2f} {:.2f}\nEOD\n", k, x, y,
                    x + sample / 2, y, x + sample, y);
                plots += fmt::format("{}$key_{} using 1:2 {}", plots.empty() ? "" : ", \\\n    ", k,
                                     key_look(*keys_[k].line));
            } else {
                say("$key_{} << EOD\n{:.2f} {:.2f} {:.2f} {:.2f}\nEOD\n", k, x + 8, x + sample, y - 6, y + 6);
                plots +=
                    fmt::format("{}$key_{} using 1:3:1:2:3:4 with boxxyerror fs solid 1 noborder lc rgb '{}'",
                                plots.empty() ? "" : ", \\\n    ", k, keys_[k].colour);
            }
        }
        say("plot {}\n", plots);
    }

    Chart& chart_;
    const Figure& figure_;
    std::vector<std::string> caption_;
    std::vector<Key> keys_;
    std::string labels_;
    double key_width_ = 0;
    std::size_t columns_ = 1, lines_ = 0;
};

}  // namespace

void compose(Chart& chart, const Figure& figure) {
    Drawing(chart, figure).compose();
}

Line line_of(const Curve& curve) {
    Line line;
    line.label = curve.label;
    line.colour = curve.colour;
    line.marker = curve.marker;
    line.variant = curve.variant;
    return line;
}

Scale log_scale(std::span<const double> values, std::string (*label)(double)) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    Scale out{true, *least / 1.35, *most * 1.35, {}};
    for (const double tick : log_ticks(out.low, out.high))
        if (tick >= out.low && tick <= out.high) out.ticks.emplace_back(tick, label(tick));
    while (out.ticks.size() > 8) {  // every second one, keeping the last
        std::vector<std::pair<double, std::string>> fewer;
        for (std::size_t i = (out.ticks.size() - 1) % 2; i < out.ticks.size(); i += 2)
            fewer.push_back(out.ticks[i]);
        out.ticks = fewer;
    }
    return out;
}

Scale linear_scale(double high, std::string (*label)(double)) {
    const double decade = std::pow(10.0, std::floor(std::log10(high)));
    double step = decade;
    for (const double factor : {0.2, 0.5, 1.0, 2.0})
        if (high / (factor * decade) <= 5) {
            step = factor * decade;
            break;
        }
    const double steps = std::ceil(high / step - 1e-9);
    Scale out{false, 0, steps * step, {}};
    for (double i = 0; i <= steps; ++i) out.ticks.emplace_back(i * step, label(i * step));
    return out;
}

std::string plain_number(double value) {
    return fmt::format("{:.10g}", value);
}

std::string byte_number(double bytes) {
    int step = 0;
    constexpr const char* units[] = {"B", "kB", "MB", "GB", "TB", "PB", "EB"};
    while (bytes >= 1000 * (1 - 1e-9) && step < 6) {
        bytes /= 1000;
        ++step;
    }
    return fmt::format("{:.4g} {}", bytes, units[step]);
}

}  // namespace regather::charts
