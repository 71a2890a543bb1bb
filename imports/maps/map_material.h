// imports/maps/map_material.h -- what a surface of a Quake III or OpenArena map is made of, judged by its
// name, its flags and its shader script: the game has textures and light maps, no materials. The rules and
// their order are in docs/import.md.
#pragma once
#include <optional>
#include <string_view>

#include "imports/maps/bsp.h"
#include "imports/maps/shader_script.h"
#include "scenes/scene.h"

namespace regather::imports {

using scenes::Material;
using scenes::MaterialKind;

/// What becomes of a surface. `open`: seen through by nature or never drawn (fog, triggers, flames, fences),
/// left out.
enum class MapSurface : std::uint8_t { solid, sky, open };

/// `script`: null when the texture has none.
MapSurface map_surface(const BspTexture& texture, const ShaderScript* script);

/// Mean colour of the texture (linear), or none: then the palette by words in the name decides. The name of
/// the material is left empty.
Material map_material(const BspTexture& texture, const ShaderScript* script,
                      const std::optional<Vec3>& texture_colour);

/// What the map compiler q3map notes in the light map where the engine shows a white surface fully lit: 255,
/// which the engine makes four times as bright ("overbright bits").
inline constexpr double light_map_white = 255.0 / 4;

/// Light that the surface gives off [W / (m^2 sr)] in its brightest channel, so that a white matt surface
/// sends on as radiance 1 what the engine shows as white: q3map_surfacelight N gives N 0.25 3 /
/// light_map_white (0.25 and 3 are q3map's areaScale and formFactorValueScale); a sky adds half of its sun,
/// spread over the hemisphere. Without a script, names that end in _<n>k mean n thousand, as the game's own
/// do, and sky is 100.
double map_radiance(const BspTexture& texture, const ShaderScript* script);

}  // namespace regather::imports
