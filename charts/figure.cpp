#include "charts/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "charts/gnuplot.h"
#include "charts/lettering.h"

namespace regather::charts {
namespace {

// All in SVG pixels.
constexpr double edge = 10, title_size = 15, small_size = 11, point_size = 10, legend_size = 12,
                 label_size = 13;
constexpr double title_at = 22, caption_at = 42, small_line = 15, label_line = 16;
constexpr double above = 18, between = 22, across_room = 42, tick_room = 14, sample = 30;
constexpr double gap_to_text = 11, gap_of_keys = 12, legend_line = 18, remark_lift = 16;
constexpr double row_gap = 34, bare_gap = 10, right_room = 16, bar_room = 100, bar_width = 16;
constexpr const char* dashes[] = {"solid", "(6,3)", "(2,3)", "(10,3,2,3)"};
constexpr const char* level_dashes[] = {"(10,5)", "(4,4)", "(2,4)", "(12,4,2,4)"};
constexpr const char* grey = "tc rgb '#505050'";

/// What the legend shows: a line's look or a box's colour.
struct Key {
    std::string label;
    const Line* line = nullptr;
    std::string colour = {};
    std::vector<std::string> texts = {};  ///< The label in lines.
    std::size_t top = 0;                  ///< Lines above its first one.
};

std::vector<Key> keys_of(const Figure& figure) {
    std::vector<Key> keys;
    const auto add = [&](Key key) {
        const bool known =
            std::any_of(keys.begin(), keys.end(), [&](const Key& k) { return k.label == key.label; });
        if (!key.label.empty() && !known) keys.push_back(std::move(key));
    };
    for (const Panel& panel : figure.panels) {
        for (const Box& box : panel.boxes) add({box.label, nullptr, box.colour});
        for (const Line& line : panel.lines) add({line.label, &line});
    }
    return keys;
}

bool is_level(const Line& line) {
    return line.form == Line::Form::level || line.form == Line::Form::rule;
}

/// `under`: how many lines with the same points are drawn over this one; it is wider by that, so that each
/// shows.
std::string look(const Line& line, int under = 0) {
    const double wider = is_level(line) ? 0 : std::min(under, 4);
    const auto variant = static_cast<std::size_t>(line.variant) % std::size(dashes);
    const std::string stroke =
        fmt::format("lc rgb '{}' lw {:.2f} dt {}", line.colour, line.width + 1.3 * wider,
                    line.form == Line::Form::level ? level_dashes[variant] : dashes[variant]);
    switch (line.form) {
        case Line::Form::plain:
        case Line::Form::rule:
            return "with lines " + stroke;
        case Line::Form::points:
            return fmt::format("with points lc rgb '{}' pt {} ps {:.2f}", line.colour, line.marker,
                               line.width / 2);
        case Line::Form::level:
        case Line::Form::joined:
        case Line::Form::steps:
            break;
    }
    return fmt::format("with linespoints {} pt {} ps {:.2f} pi {}", stroke, line.marker, 0.8 + 0.28 * wider,
                       line.every);
}

std::string key_look(Line line) {
    line.every = 1;
    return look(line);
}

/// A panel's place on the canvas.
struct Place {
    double left, right, top, bottom;
};

class Drawing {
public:
    explicit Drawing(const Figure& figure) : figure_(figure), keys_(keys_of(figure)) {
        chart_.title = figure.title;
        chart_.caption = figure.caption;
        caption_ = wrapped(figure.caption, small_size, figure.width - 2 * edge);
        lay_out();
    }

    Chart draw() {
        say("set encoding utf8\nset multiplot\nset border 3 lc rgb '#404040'\n"
            "set tics nomirror out scale 0.6\nset grid xtics ytics lt 1 lc rgb '#e4e4e4' lw 0.6\nunset key\n"
            "set datafile missing '-'\nunset colorbox\n");
        label(chart_.title, edge, title_at, fmt::format("left font ',{}'", title_size));
        for (std::size_t i = 0; i < caption_.size(); ++i)
            label(caption_[i], edge, caption_at + small_line * static_cast<double>(i),
                  fmt::format("left font ',{}' {}", small_size, grey));
        if (figure_.colours) {
            const Scale& colours = *figure_.colours;
            say("set logscale cb\nset cbrange [{:.10g}:{:.10g}]\nset palette defined (0 '#2c105c', 1 "
                "'#711f81', 2 '#b63679', 3 '#ee605e', 4 '#fdae78', 5 '#fcfdbf')\n",
                colours.low, colours.high);
        }
        for (std::size_t p = 0; p < figure_.panels.size(); ++p) draw(figure_.panels[p], p);
        legend();
        say("unset multiplot\n");
        return std::move(chart_);
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
    const Axis& across(const Panel& panel) const { return panel.across ? *panel.across : figure_.across; }
    /// Lines of the vertical axis's label, which is as long as the panel and the gap to the next one allow.
    static std::vector<std::string> up_label(const Panel& panel) {
        return wrapped(panel.up.label, label_size, panel.height + (panel.bare ? 0 : between / 2));
    }
    static std::vector<std::string> remark(const Panel& panel, double width) {
        return wrapped(panel.remark, small_size, width);
    }
    bool begins_row(std::size_t p) const { return !figure_.panels[p].beside; }
    bool ends_row(std::size_t p) const { return p + 1 == figure_.panels.size() || begins_row(p + 1); }
    /// Whether a panel shows the labels of its horizontal axis: the last one of those that share it.
    bool has_across(std::size_t p) const {
        const Panel& panel = figure_.panels[p];
        if (panel.raster) return false;
        return panel.across || p + 1 == figure_.panels.size();
    }

    /// Room left of the panels: for tick labels and for what the axes are.
    double margin() const {
        double room = 0;
        for (std::size_t p = 0; p < figure_.panels.size(); ++p) {
            const Panel& panel = figure_.panels[p];
            if (!begins_row(p)) continue;
            if (panel.bare) {
                if (!panel.up.label.empty())
                    room = std::max(room, text_width(panel.up.label, label_size) + 8);
                room = std::max(room, overhangs(panel, figure_.width - edge - right_room).first - edge);
                continue;
            }
            double widest = 0;
            for (const auto& [value, text] : panel.up.scale.ticks)
                widest = std::max(widest, text_width(text, panel.tick_size));
            room =
                std::max(room, widest + tick_room + label_line * static_cast<double>(up_label(panel).size()));
        }
        return edge + room;
    }

    /// How far the first and the last label of the axis across a panel, `width` wide, reach beyond it.
    std::pair<double, double> overhangs(const Panel& panel, double width) const {
        if (panel.raster || across(panel).scale.ticks.empty()) return {0, 0};
        const Scale& scale = across(panel).scale;
        const auto beyond = [&](const auto& tick, double inside) {
            return std::max(0.0, text_width(tick.second, label_size) / 2 + 2 - inside * width);
        };
        return {beyond(scale.ticks.front(), scale.share(scale.ticks.front().first)),
                beyond(scale.ticks.back(), 1 - scale.share(scale.ticks.back().first))};
    }

    void lay_out() {
        const double left = margin(), right = figure_.width - (figure_.colours ? bar_room : right_room);
        double y = caption_at + small_line * static_cast<double>(std::max<std::size_t>(caption_.size(), 1)) -
                   8 + above;
        for (std::size_t p = 0; p < figure_.panels.size();) {
            std::size_t end = p + 1;
            double shares = figure_.panels[p].share + figure_.panels[p].room_beside,
                   height = figure_.panels[p].height;
            for (; end < figure_.panels.size() && !begins_row(end); ++end) {
                shares += figure_.panels[end].share + figure_.panels[end].room_beside;
                height = std::max(height, figure_.panels[end].height);
            }
            const double gap = figure_.panels[p].raster ? bare_gap : row_gap;
            const double gaps = static_cast<double>(end - p - 1) + figure_.panels[end - 1].room_beside;
            double width = right - left - gap * gaps;
            if (!figure_.colours) {
                const Panel& last = figure_.panels[end - 1];
                width -= std::max(0.0, overhangs(last, width * last.share / shares).second - right_room);
            }
            double x = left, lift = 0;
            for (std::size_t i = p; i < end; ++i) {
                const double own = width * figure_.panels[i].share / shares;
                places_.push_back({x, x + own, 0, 0});
                const std::size_t lines = remark(figure_.panels[i], own).size();
                if (lines > 0) lift = std::max(lift, small_line * static_cast<double>(lines) + 6);
                x += own + gap;
            }
            bool labelled = false;
            for (std::size_t i = p; i < end; ++i) {
                places_[i].top = y + lift;
                places_[i].bottom = y + lift + height;
                labelled |= has_across(i);
            }
            y += lift + height +
                 (labelled                   ? across_room + small_line
                  : figure_.panels[p].raster ? 8
                                             : between);
            p = end;
        }
        legend_top_ = y;
        lay_out_legend();
        chart_.width = static_cast<unsigned>(std::ceil(figure_.width));
        chart_.height =
            static_cast<unsigned>(std::ceil(y + legend_line * static_cast<double>(legend_lines_) + 6));
    }

    /// As many columns as there is room for, up to four; each as wide as its longest key. In a single column
    /// a key that is too long takes several lines.
    void lay_out_legend() {
        const double room = figure_.width - 2 * edge;
        for (std::size_t columns = std::clamp<std::size_t>(keys_.size(), 1, 4); columns > 0; --columns) {
            key_lines_ = (keys_.size() + columns - 1) / columns;
            std::vector<double> widths;
            for (std::size_t first = 0; first < keys_.size(); first += key_lines_) {
                double longest = 0;
                for (std::size_t k = first; k < std::min(first + key_lines_, keys_.size()); ++k)
                    longest = std::max(longest, text_width(keys_[k].label, legend_size));
                widths.push_back(sample + gap_to_text + longest + gap_of_keys);
            }
            const double needed = std::accumulate(widths.begin(), widths.end(), 0.0);
            if (needed > room + gap_of_keys && columns > 1) continue;
            const double spare =
                std::max(0.0, room - needed) / static_cast<double>(std::max<std::size_t>(widths.size(), 1));
            double x = edge;
            for (const double width : widths) {
                key_columns_.push_back(x);
                x += width + spare;
            }
            for (std::size_t k = 0; k < keys_.size(); ++k) {
                Key& key = keys_[k];
                if (columns > 1)
                    key.texts = {key.label};
                else
                    key.texts = wrapped(key.label, legend_size, room - sample - gap_to_text);
                key.top = columns > 1 ? k % key_lines_ : legend_lines_;
                legend_lines_ = std::max(legend_lines_, key.top + key.texts.size());
            }
            return;
        }
    }

    void scale(char axis, const Scale& scale) {
        say("{}set logscale {}\nset {}range [{:.10g}:{:.10g}]\n", scale.log ? "" : "un", axis, axis,
            scale.low, scale.high);
    }
    void ticks(char axis, const Scale& scale, const std::vector<bool>& labelled, double size) {
        say("set {}tics nomirror out scale 0.6 noenhanced font ',{}' (", axis, size);
        for (std::size_t i = 0; i < scale.ticks.size(); ++i)
            say("{}{} {:.10g}", i == 0 ? "" : ", ", gnuplot_string(labelled[i] ? scale.ticks[i].second : ""),
                scale.ticks[i].first);
        say(")\n");
    }
    /// From the last one on, those whose labels do not touch.
    static std::vector<bool> apart_across(const Scale& scale, double pixels) {
        std::vector<bool> out(scale.ticks.size());
        double taken = std::numeric_limits<double>::infinity();
        for (std::size_t i = scale.ticks.size(); i-- > 0;) {
            const double middle = scale.share(scale.ticks[i].first) * pixels;
            const double half = text_width(scale.ticks[i].second, label_size) / 2 + 2;
            if (middle + half > taken) continue;
            out[i] = true;
            taken = middle - half;
        }
        return out;
    }

    void draw(const Panel& panel, std::size_t p) {
        const Place& place = places_[p];
        const double middle = (place.top + place.bottom) / 2, width = place.right - place.left;
        say("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset tmargin at screen {:.5f}\nset "
            "bmargin at screen {:.5f}\n",
            x_at(place.left), x_at(place.right), y_at(place.top), y_at(place.bottom));
        const Axis& horizontal = across(panel);
        if (panel.raster) {
            draw(*panel.raster, panel, place);
            return;
        }
        scale('x', horizontal.scale);
        scale('y', panel.up.scale);
        std::vector<bool> all(panel.up.scale.ticks.size(), begins_row(p));
        std::vector<bool> labelled = apart_across(horizontal.scale, width);
        if (!has_across(p)) labelled.assign(labelled.size(), false);
        if (panel.bare) {
            say("unset border\nunset grid\nunset xtics\nunset ytics\n");
            if (has_across(p)) ticks('x', horizontal.scale, labelled, label_size);
            label(panel.up.label, place.left - 8, middle, "right");
        } else {
            say("set border 3 lc rgb '#404040'\nset grid xtics ytics lt 1 lc rgb '#e4e4e4' lw 0.6\n");
            ticks('x', horizontal.scale, labelled, label_size);
            ticks('y', panel.up.scale, all, panel.tick_size);
            const auto lines = up_label(panel);
            for (std::size_t i = 0; i < lines.size(); ++i)
                label(lines[i], edge + 4 + label_line * static_cast<double>(i), middle,
                      "center rotate by 90");
        }
        remark(panel, place);
        if (has_across(p))
            label(horizontal.label, (place.left + place.right) / 2, place.bottom + across_room, "center");
        for (const Note& note : panel.notes)
            say("set label {} at {:.10g},{:.10g} {} noenhanced font ',{}'\n", gnuplot_string(note.text),
                note.x, note.y, note.at_right ? "right" : "left", small_size);
        data(panel, p, width);
        say("unset label\n");
    }

    /// Above the panel, clear of the uppermost tick's label.
    void remark(const Panel& panel, const Place& place) {
        const auto lines = remark(panel, place.right - place.left);
        for (std::size_t i = 0; i < lines.size(); ++i)
            label(lines[i], place.left,
                  place.top - remark_lift +
                      small_line * (static_cast<double>(i) + 1 - static_cast<double>(lines.size())),
                  fmt::format("left font ',{}' {}", small_size, grey));
    }

    void draw(const Raster& raster, const Panel& panel, const Place& place) {
        // gnuplot draws no image of one row or column: it is there twice.
        const std::uint32_t columns = std::max(raster.width, 2u), rows = std::max(raster.height, 2u);
        say("unset logscale x\nunset logscale y\nset xrange [-0.5:{}.5]\nset yrange [{}.5:-0.5]\nset border "
            "15 "
            "lw 0.5\nunset xtics\nunset ytics\nunset grid\n",
            columns - 1, rows - 1);
        remark(panel, place);
        const bool is_last = &panel == &figure_.panels.back();
        if (is_last && figure_.colours) {
            const double top = places_.front().top, bottom = place.bottom;
            say("set colorbox user origin screen {:.5f},{:.5f} size screen {:.5f},{:.5f}\nset cbtics (",
                x_at(figure_.width - bar_room + 14), y_at(bottom), bar_width / chart_.width,
                (bottom - top) / chart_.height);
            for (std::size_t i = 0; i < figure_.colours->ticks.size(); ++i)
                say("{}{} {:.10g}", i == 0 ? "" : ", ", gnuplot_string(figure_.colours->ticks[i].second),
                    figure_.colours->ticks[i].first);
            say(")\n");
        }
        say("plot '-' matrix with image pixels\n");
        for (std::uint32_t row = 0; row < rows; ++row) {
            const std::size_t y = std::min(row, raster.height - 1);
            for (std::uint32_t column = 0; column < columns; ++column) {
                const std::uint32_t x = std::min(column, raster.width - 1);
                const std::uint64_t value = raster.values[y * raster.width + x];
                if (value == 0) {
                    chart_.commands += "- ";
                } else {
                    say("{} ", value);
                }
            }
            chart_.commands += '\n';
        }
        say("e\nunset label\n");
    }

    void data(const Panel& panel, std::size_t p, double width) {
        std::string plots;
        const auto add = [&](const std::string& plot) {
            plots += (plots.empty() ? "" : ", \\\n    ") + plot;
        };
        const Scale& horizontal = across(panel).scale;
        for (std::size_t b = 0; b < panel.boxes.size(); ++b) {
            const Box& box = panel.boxes[b];
            say("# {}\n$box_{}_{} << EOD\n{:.10g} {:.10g} {:.10g} {:.10g}\nEOD\n", gnuplot_string(box.label),
                p, b, box.left, box.right, box.bottom, box.top);
            add(fmt::format("$box_{}_{} using 1:3:1:2:3:4 with boxxyerror fs solid 1 noborder lc rgb '{}'", p,
                            b, box.colour));
            const double from = horizontal.share(box.left), to = horizontal.share(box.right);
            if (box.text.empty() || (to - from) * width < text_width(box.text, small_size) + 4) continue;
            say("set label {} at {:.10g},{:.10g} center noenhanced font ',{}' tc rgb '{}' front\n",
                gnuplot_string(box.text), horizontal.at((from + to) / 2), (box.bottom + box.top) / 2,
                small_size, box.text_colour);
        }
        for (std::size_t l = 0; l < panel.lines.size(); ++l) {
            const Line& line = panel.lines[l];
            if (line.points.empty()) continue;
            const auto same = [&](const Line& other) {
                return is_level(other) == is_level(line) && other.points == line.points;
            };
            const auto at = panel.lines.begin() + static_cast<std::ptrdiff_t>(l);
            const auto under = static_cast<int>(std::count_if(at + 1, panel.lines.end(), same));
            const auto over = static_cast<double>(std::count_if(panel.lines.begin(), at, same));
            std::vector<Point> points = line.points;
            if (is_level(line)) {
                // Level lines of the same height: each is a marker shorter than the one it lies on, so that
                // each shows.
                const double inset = line.form == Line::Form::level ? 0.028 * std::min(over, 8.0) : 0;
                points.push_back(points.front());
                points.front().x = horizontal.at(inset);
                points.back().x = horizontal.at(1 - inset);
            }
            draw(line, points, under, fmt::format("{}_{}", p, l), panel, places_[p], add);
        }
        say("{}plot {}\n", labels_, plots.empty() ? "NaN notitle" : plots);
        labels_.clear();
        taken_.clear();
    }

    template <class Add>
    void draw(const Line& line, const std::vector<Point>& points, int under, const std::string& number,
              const Panel& panel, const Place& place, const Add& add) {
        const std::string name = "$line_" + number;
        say("# {}\n{} << EOD\n", gnuplot_string(line.label), name);
        for (const Point& point : points) {
            if (std::isnan(point.x))
                say("\n");
            else
                say("{:.10g} {:.10g}\n", point.x, point.y);
            if (!point.label.empty() && is_free(point, panel, place))
                labels_ += fmt::format(
                    "set label {} at {:.10g},{:.10g} noenhanced font ',{}' tc rgb '{}' left offset "
                    "0.5,0.45\n",
                    gnuplot_string(point.label), point.x, point.y, point_size, line.colour);
        }
        say("EOD\n");
        bars(line, points, "$bars_" + number, add);
        if (line.form != Line::Form::steps)
            return add(fmt::format("{} using 1:2 {}", name, look(line, under)));
        add(fmt::format("{} using 1:2 with steps lc rgb '{}' lw {:.2f}", name, line.colour, line.width));
        // The last point only carries the last step to the edge.
        add(fmt::format("{} every ::0::{} using 1:2 with points lc rgb '{}' pt {} ps 0.7", name,
                        points.size() - 2, line.colour, line.marker));
    }

    /// Whether a point's label, at its right and a little up, meets none that stands already; then it stands.
    bool is_free(const Point& point, const Panel& panel, const Place& place) {
        const double x = place.left + across(panel).scale.share(point.x) * (place.right - place.left);
        const double y = place.bottom - panel.up.scale.share(point.y) * (place.bottom - place.top);
        const Place own{x, x + text_width(point.label, point_size) + 4, y - point_size - 2, y};
        for (const Place& other : taken_)
            if (own.left < other.right && other.left < own.right && own.top < other.bottom &&
                other.top < own.bottom)
                return false;
        taken_.push_back(own);
        return true;
    }

    template <class Add>
    void bars(const Line& line, const std::vector<Point>& points, const std::string& name, const Add& add) {
        const auto has_bar = [](const Point& point) { return !std::isnan(point.low); };
        if (std::none_of(points.begin(), points.end(), has_bar)) return;
        say("{} << EOD\n", name);
        for (const Point& point : points)
            if (has_bar(point))
                say("{:.10g} {:.10g} {:.10g} {:.10g}\n", point.x, point.y, point.low, point.high);
        say("EOD\n");
        add(fmt::format("{} using 1:2:3:4 with yerrorbars lc rgb '{}' lw 1 dt solid pt 0", name,
                        line.colour));
    }

    /// A plot of its own over the whole canvas in pixels, as gnuplot drops entries that do not fit beside
    /// their plot.
    void legend() {
        if (keys_.empty()) return;
        say("unset border\nunset tics\nunset grid\nunset logscale\n"
            "set lmargin at screen 0\nset rmargin at screen 1\nset tmargin at screen 1\nset bmargin at "
            "screen 0\nset xrange [0:{}]\nset yrange [{}:0]\n",
            chart_.width, chart_.height);
        std::string plots;
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            const double x = key_columns_[k / key_lines_];
            const double y = legend_top_ + legend_line * (static_cast<double>(keys_[k].top) + 0.5);
            for (std::size_t i = 0; i < keys_[k].texts.size(); ++i)
                label(
                    fitting(keys_[k].texts[i], legend_size, figure_.width - edge - x - sample - gap_to_text),
                    x + sample + gap_to_text, y + legend_line * static_cast<double>(i),
                    fmt::format("left font ',{}'", legend_size));
            const char* separator = plots.empty() ? "" : ", \\\n    ";
            if (keys_[k].line != nullptr) {
                const bool alone = keys_[k].line->form == Line::Form::points;
                say("$key_{} << EOD\n", k);
                for (const double share : {0.0, 0.5, 1.0})
                    if (!alone || share == 0.5) say("{:.2f} {:.2f}\n", x + sample * share, y);
                say("EOD\n");
                plots += fmt::format("{}$key_{} using 1:2 {}", separator, k, key_look(*keys_[k].line));
            } else {
                say("$key_{} << EOD\n{:.2f} {:.2f} {:.2f} {:.2f}\nEOD\n", k, x + 8, x + sample, y - 6, y + 6);
                plots +=
                    fmt::format("{}$key_{} using 1:3:1:2:3:4 with boxxyerror fs solid 1 noborder lc rgb '{}'",
                                separator, k, keys_[k].colour);
            }
        }
        say("plot {}\n", plots);
    }

    const Figure& figure_;
    Chart chart_;
    std::vector<std::string> caption_;
    std::vector<Key> keys_;
    std::vector<Place> places_;
    std::string labels_;        ///< Of the points of a panel ...
    std::vector<Place> taken_;  ///< ... and where they are.
    std::vector<double> key_columns_;
    double legend_top_ = 0;
    std::size_t key_lines_ = 0;     ///< Keys of a column.
    std::size_t legend_lines_ = 0;  ///< Of text.
};

}  // namespace

Chart draw(const Figure& figure) {
    return Drawing(figure).draw();
}

}  // namespace regather::charts
