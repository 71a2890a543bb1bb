// imports/maps/shader_script.h -- what the shader scripts of Quake III and OpenArena (scripts/*.shader) say
// about surfaces, as far as an importer of geometry and light needs it (P. Jaquays & B. Hook, "Quake III
// Arena Shader Manual", 1999). Keywords are read without regard to case; those that are not used are counted.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trace/vec.h"

namespace regather::imports {

struct ShaderScript {
    std::string name;                         ///< As in the file: "textures/e7/e7bricks01".
    std::vector<std::string> surface_parms;   ///< "surfaceparm sky" gives "sky"; lower case.
    double surface_light = 0;                 ///< q3map_surfacelight; 0: no light.
    std::string light_image;                  ///< q3map_lightimage: its mean colour is the light's.
    std::string editor_image;                 ///< qer_editorimage
    std::optional<trace::Vec3> light_colour;  ///< q3map_lightRGB
    double sun_intensity = 0;  ///< Of q3map_sun or q3map_sunExt: in units of the light map, 255 is white.
    trace::Vec3 sun_colour;
    std::string map;  ///< Image of the first stage that has one of its own ($lightmap, $whiteimage are none).
    bool environment = false;   ///< A stage with tcGen environment: it shines.
    bool see_through = false;   ///< The first stage is blended with what is behind it: flames, beams, glass.
    bool alpha_tested = false;  ///< A stage with alphaFunc: fences, leaves.
    bool portal = false;        ///< surfaceparm or sort portal: a mirror.
    std::map<std::string, std::uint64_t>
        left_out;  ///< Directives that nothing above says, in lower case, and how often.

    bool has_parm(std::string_view parm) const;
};

/// All shaders of a script, in its order. Comments are // and /* */. Throws trace::DataError that names
/// `file` and the line when a brace is missing or too many, or braces are nested more than twice. What is no
/// number counts as 0.
std::vector<ShaderScript> read_shader_scripts(std::string_view text, std::string_view file);

}  // namespace regather::imports
