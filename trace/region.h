// trace/region.h -- what a byte belongs to, so that traffic can be told apart by data structure.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace regather::trace {

enum class Region : std::uint8_t {
    photons,
    reorder_buffer,
    other,
    nodes,
    photon_power,
    directory,
    triangles,
    stack,
    irradiance
};

inline constexpr std::array<std::string_view, 9> region_names{"photons",   "reorder_buffer", "other",
                                                              "nodes",     "photon_power",   "directory",
                                                              "triangles", "stack",          "irradiance"};
inline constexpr std::size_t region_count = region_names.size();

}  // namespace regather::trace
