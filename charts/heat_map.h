// charts/heat_map.h -- bytes moved a pixel as pictures in false colour, one panel an ordering, all under one
// logarithmic scale.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "charts/figure.h"

namespace regather::charts {

struct HeatMap {
    std::string title;
    std::vector<std::uint64_t> bytes;  ///< By pixel in row order, first row at the top.
};

/// `caption` stands under the title. Pixels that moved nothing are white. Every map has width x height
/// values.
Chart heat_map(std::span<const HeatMap> maps, std::uint32_t width, std::uint32_t height,
               const std::string& caption);

/// Drawn as PNG and written; an existing file is replaced. Throws std::runtime_error as render().
void write_heat_map(const std::filesystem::path& png, std::span<const HeatMap> maps, std::uint32_t width,
                    std::uint32_t height, const std::string& caption);

}  // namespace regather::charts
