#include "charts/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "charts/chart.h"
#include "results/geometry.h"
#include "trace/file.h"

namespace regather::charts {
namespace {

constexpr double panel_pixels = 300, gap_pixels = 10, others = 110;  // the edge and the colour bar
constexpr std::size_t panels_a_row = 3;

/// Whole decades about the values above 0.
Scale colours_of(std::span<const HeatMap> maps) {
    double least = 1e300, most = 1;
    for (const HeatMap& map : maps)
        for (const std::uint64_t bytes : map.bytes) {
            if (bytes == 0) continue;
            least = std::min(least, static_cast<double>(bytes));
            most = std::max(most, static_cast<double>(bytes));
        }
    Scale out{true,
              std::pow(10.0, std::floor(std::log10(std::min(least, most)))),
              std::pow(10.0, std::ceil(std::log10(most * 1.0001))),
              {}};
    for (double value = out.low; value <= out.high * 1.001; value *= 10)
        out.ticks.emplace_back(value, results::decimal_bytes(static_cast<std::uint64_t>(value)));
    return out;
}

}  // namespace

Chart heat_map(std::span<const HeatMap> maps, std::uint32_t width, std::uint32_t height,
               const std::string& caption) {
    Figure figure{"Bytes moved a pixel", caption, {}};
    const std::size_t columns = std::clamp<std::size_t>(maps.size(), 1, panels_a_row);
    figure.width = static_cast<double>(columns) * (panel_pixels + gap_pixels) - gap_pixels + others;
    figure.colours = colours_of(maps);
    for (std::size_t i = 0; i < maps.size(); ++i) {
        std::uint64_t sum = 0;
        for (const std::uint64_t bytes : maps[i].bytes) sum += bytes;
        Panel panel;
        panel.height = std::max(40.0, panel_pixels * height / width);
        panel.beside = i % columns != 0;
        panel.bare = true;
        panel.raster = Raster{width, height, maps[i].bytes};
        panel.remark = fmt::format("{}: {}", maps[i].title, results::decimal_bytes(sum));
        figure.panels.push_back(std::move(panel));
    }
    // A row that is not full keeps its panels' size.
    if (const std::size_t last = maps.size() % columns; maps.size() > columns && last != 0)
        figure.panels.back().room_beside = static_cast<double>(columns - last);
    return draw(figure);
}

void write_heat_map(const std::filesystem::path& png, std::span<const HeatMap> maps, std::uint32_t width,
                    std::uint32_t height, const std::string& caption) {
    trace::write_whole(png, render(heat_map(maps, width, height, caption), Picture::png));
}

}  // namespace regather::charts
