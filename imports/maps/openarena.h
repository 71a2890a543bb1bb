// imports/maps/openarena.h -- scenes from maps of OpenArena (and Quake III Arena): faces and curved patches
// of an IBSP 46 file, materials by texture names, images and shader scripts, lights by q3map_surfacelight, a
// camera path through the spawn points. All rules are in docs/import.md.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "imports/scene_file.h"

namespace regather::imports {

/// 56 units are a player, 1.75 m.
inline constexpr float metres_a_game_unit = 1.0f / 32;

struct OpenArenaOptions {
    std::string map;                ///< "oa_shouse" for maps/oa_shouse.bsp.
    std::uint32_t subdivision = 6;  ///< Steps along each side of a curved patch, 1 to 32.
};

/// Where archives have an entry of the same name, the last one counts, as in the game. Throws
/// trace::UsageError when the map is not named or in none of them (it lists those that are), trace::DataError
/// for damaged archives, maps, shader scripts and images, maps without a spawn point or with more than four
/// million triangles.
ImportedScene import_openarena(std::span<const std::filesystem::path> archives,
                               const OpenArenaOptions& options);

}  // namespace regather::imports
