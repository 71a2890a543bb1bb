#include "charts/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "charts/gnuplot.h"

namespace regather::charts {
namespace {

// An error of 0 has no place on a log axis: what is smaller is drawn here.
constexpr double least_drawn = 1e-18;

std::string cut(const std::string& text, std::size_t most) {
    return text.size() > most ? text.substr(0, most - 3) + "..." : text;
}

std::string number(const std::optional<double>& value) {
    return !value ? "not finite" : *value == 0 ? "0" : fmt::format("{:.2e}", *value);
}

double drawn(const std::optional<double>& value, double otherwise) {
    return std::clamp(value.value_or(otherwise), least_drawn, 1e3);
}

}  // namespace

std::string stability_table(std::span<const results::StabilityRow> rows) {
    if (rows.empty()) return "";
    std::string out = fmt::format("{:<10} {:<46} {:>10} {:>10} {:>8}  {}\n", "group", "case", "error",
                                  "allowed", "seconds", "of");
    std::size_t passed = 0;
    for (const results::StabilityRow& row : rows) {
        const bool good = row.passed.value_or(false);
        passed += good;
        out += fmt::format("{:<10} {:<46} {:>10} {:>10} {:>8.2f}  {}{}\n", cut(row.group, 10),
                           cut(row.stability_case, 46), number(row.error), number(row.allowed_error),
                           row.seconds.value_or(0), row.quantity, good ? "" : "  FAILED");
    }
    return out + fmt::format("{} of {} cases passed\n", passed, rows.size());
}

Chart stability(const ChartKind& kind, const Rows& rows, const ChartOptions&) {
    if (rows.stability.empty()) return skip(fmt::format("needs {}", kind.needs));
    constexpr unsigned row_height = 17, top = 70, bottom = 60;
    const std::size_t count = rows.stability.size();
    Chart chart;
    chart.title = kind.title;
    chart.caption = fmt::format("{} cases; an error below 1e-18 is drawn at the left edge", count);
    chart.width = 980;
    chart.height = top + bottom + static_cast<unsigned>(count) * row_height;

    std::string labels, good, bad, allowed, seconds;
    for (std::size_t i = 0; i < count; ++i) {
        const results::StabilityRow& row = rows.stability[i];
        const std::size_t y = count - i;
        labels +=
            fmt::format("{}{} {}", i == 0 ? "" : ", ",
                        gnuplot_string(fmt::format("{}: {}", row.group, cut(row.stability_case, 52))), y);
        (row.passed.value_or(false) ? good : bad) += fmt::format("{} {}\n", drawn(row.error, 1e3), y);
        allowed += fmt::format("{} {}\n", drawn(row.allowed_error, 1e3), y);
        seconds += fmt::format("{} {}\n", std::clamp(row.seconds.value_or(0), 1e-4, 1e4), y);
    }
    const double high = static_cast<double>(count) + 0.7;
    chart.commands = fmt::format(
        "$good << EOD\n{}EOD\n$bad << EOD\n{}EOD\n$allowed << EOD\n{}EOD\n$seconds << EOD\n{}EOD\n", good,
        bad, allowed, seconds);
    chart.commands += fmt::format(
        "set multiplot title {} font 'DejaVu Sans,15'\n"
        "set lmargin at screen 0.42\nset rmargin at screen 0.80\nset tmargin at screen {:.4f}\nset bmargin "
        "at screen {:.4f}\n"
        "set logscale x\nset xrange [{}:2000]\nset yrange [0.3:{}]\nset format x '10^{{%T}}'\nset xtics 1e3\n"
        "set ytics ({}) scale 0 noenhanced font 'DejaVu Sans,10'\nset grid xtics ytics lc rgb '#e0e0e0'\nset "
        "border 3 "
        "lc rgb '#808080'\n"
        "set tics nomirror\nset xlabel 'error'\nset key at screen 0.8,{:.4f} right bottom horizontal font "
        "'DejaVu Sans,11'\n",
        gnuplot_string(chart.title), 1 - static_cast<double>(top) / chart.height,
        static_cast<double>(bottom) / chart.height, least_drawn / 2, high, labels,
        1 - 0.92 * static_cast<double>(top) / chart.height);
    std::string plots = "$allowed using 1:2 with points pt 2 ps 0.7 lw 1.5 lc rgb '#303030' title 'allowed'";
    if (!good.empty()) plots += ", $good using 1:2 with points pt 7 ps 0.7 lc rgb '#2a78b5' title 'measured'";
    if (!bad.empty())
        plots +=
            ", $bad using 1:2 with points pt 13 ps 1.2 lc rgb '#c8321e' title 'measured, more than allowed'";
    chart.commands += "plot " + plots + "\n";
    chart.commands +=
        "set lmargin at screen 0.83\nset rmargin at screen 0.98\nunset key\nset xrange [0.0005:1000]\nset "
        "xtics 100\n"
        "set xlabel 'seconds'\nunset ytics\n"
        "plot $seconds using 1:2 with points pt 5 ps 0.6 lc rgb '#7a7a7a' notitle\nunset multiplot\n";
    return chart;
}

}  // namespace regather::charts
