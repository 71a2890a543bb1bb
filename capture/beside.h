// capture/beside.h -- the traces that a capture may have beside that of its gathers.
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

namespace regather::capture {

enum class Beside {
    caustic,             ///< Searches of the caustic map.
    guide,               ///< Searches that choose directions; has photons of its own.
    precompute,          ///< Searches at photons, before any gather.
    reverse,             ///< The photons' searches of hit points.
    irradiance,          ///< Searches of the octree of irradiance records ...
    irradiance_rounds,   ///< ... those of the rounds that made it ...
    irradiance_inserts,  ///< ... and what was inserted into it.
};

/// Their folders, by Beside.
inline constexpr std::array<std::string_view, 7> beside_folders = {
    "caustic-trace",    "guide-trace",       "precompute-trace",  "reverse-trace",
    "irradiance-trace", "irradiance-rounds", "irradiance-inserts"};

/// One of each.
template <class T>
struct OfBeside {
    std::array<T, beside_folders.size()> all{};

    T& operator[](Beside trace) { return all[static_cast<std::size_t>(trace)]; }
    const T& operator[](Beside trace) const { return all[static_cast<std::size_t>(trace)]; }
};

}  // namespace regather::capture
