#include "charts/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "charts/gnuplot.h"
#include "results/geometry.h"
#include "trace/file.h"

namespace regather::charts {
namespace {

constexpr int panel_pixels = 300, bar_pixels = 110, head_pixels = 76;
constexpr std::size_t panels_a_row = 3;

}  // namespace

std::string heat_map_script(std::span<const HeatMap> maps, std::uint32_t width, std::uint32_t height,
                            const std::string& caption) {
    std::uint64_t most = 1;
    double least = 1e300;
    for (const HeatMap& map : maps)
        for (const std::uint64_t bytes : map.bytes) {
            most = std::max(most, bytes);
            if (bytes > 0) least = std::min(least, static_cast<double>(bytes));
        }
    least = std::min(least, static_cast<double>(most));
    const double low = std::pow(10.0, std::floor(std::log10(least))),
                 high = std::pow(10.0, std::ceil(std::log10(static_cast<double>(most) * 1.0001)));
    const std::size_t columns = std::max<std::size_t>(1, std::min(maps.size(), panels_a_row));
    const std::size_t rows = std::max<std::size_t>(1, (maps.size() + columns - 1) / columns);
    const double aspect = static_cast<double>(height) / width;
    const int panel_height = std::max(40, static_cast<int>(panel_pixels * aspect)) + 26;
    const int picture_width = static_cast<int>(columns) * (panel_pixels + 10) + bar_pixels;
    const int picture_height = static_cast<int>(rows) * panel_height + head_pixels;

    std::string script = fmt::format(
        "set terminal pngcairo size {},{} font 'DejaVu Sans,11' noenhanced\n"
        "set multiplot\nset label 1 {} at screen 0.02, screen {:.4f} font 'DejaVu Sans,13'\n"
        "set label 2 {} at screen 0.02, screen {:.4f} font 'DejaVu Sans,9'\n"
        "set logscale cb\nset cbrange [{:.6g}:{:.6g}]\nset palette defined (0 '#2c105c', 1 '#711f81', 2 "
        "'#b63679', 3 '#ee605e', 4 "
        "'#fdae78', 5 '#fcfdbf')\nunset key\nunset xtics\nunset ytics\nset border lw 0.5\nset datafile "
        "missing '-'\n"
        "set xrange [-0.5:{}.5]\nset yrange [{}.5:-0.5]\nset size ratio {:.6g}\nunset colorbox\n",
        picture_width, picture_height, gnuplot_string("Bytes moved a pixel"), 1 - 18.0 / picture_height,
        gnuplot_string(caption), 1 - 40.0 / picture_height, low, high, width - 1, height - 1, aspect);
    std::string ticks;
    for (double value = low; value <= high * 1.001; value *= 10)
        ticks +=
            fmt::format("{}{} {:.6g}", ticks.empty() ? "" : ", ",
                        gnuplot_string(results::decimal_bytes(static_cast<std::uint64_t>(value))), value);
    for (std::size_t i = 0; i < maps.size(); ++i) {
        const std::size_t column = i % columns, row = i / columns;
        const double left = (static_cast<double>(column) * (panel_pixels + 10) + 8) / picture_width;
        const double right = left + static_cast<double>(panel_pixels) / picture_width;
        const double top =
            1 - static_cast<double>(head_pixels - 2 + static_cast<int>(row) * panel_height) / picture_height;
        const double bottom = top - static_cast<double>(panel_height - 26) / picture_height;
        std::uint64_t sum = 0;
        for (const std::uint64_t bytes : maps[i].bytes) sum += bytes;
        script += fmt::format(
            "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset tmargin at screen {:.5f}\nset "
            "bmargin at "
            "screen {:.5f}\nset label 3 {} at graph 0, graph 1 offset 0, 0.7 font 'DejaVu Sans,10'\n",
            left, right, top, bottom,
            gnuplot_string(fmt::format("{}: {}", maps[i].title, results::decimal_bytes(sum))));
        if (i + 1 == maps.size())
            script += fmt::format(
                "set colorbox user origin screen {:.5f}, screen 0.06 size screen {:.5f}, screen {:.5f}\nset "
                "cbtics ({})\n",
                1 - (bar_pixels - 14.0) / picture_width, 16.0 / picture_width,
                0.9 - static_cast<double>(head_pixels) / picture_height, ticks);
        script += "plot '-' matrix with image pixels\n";
        for (std::uint32_t y = 0; y < height; ++y) {
            for (std::uint32_t x = 0; x < width; ++x) {
                const std::uint64_t bytes = maps[i].bytes[std::size_t{y} * width + x];
                if (bytes == 0) {
                    script += "- ";
                } else {
                    fmt::format_to(std::back_inserter(script), "{} ", bytes);
                }
            }
            script += '\n';
        }
        script += "e\nunset label 1\nunset label 2\n";
    }
    return script + "unset multiplot\n";
}

void write_heat_map(const std::filesystem::path& png, std::span<const HeatMap> maps, std::uint32_t width,
                    std::uint32_t height, const std::string& caption) {
    trace::write_whole(png, run_gnuplot(heat_map_script(maps, width, height, caption)));
}

}  // namespace regather::charts
