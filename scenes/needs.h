// scenes/needs.h -- what a scene needs of a capture, derived from what is in it. The rest is left out: not
// traced, not stored, not replayed. The reasons are for the terminal and for trace.json.
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "scenes/scene.h"

namespace regather::scenes {

struct Need {
    std::string_view part;  ///< As users see it: "shadow_rays".
    bool needed = false;
    std::string reason;  ///< One sentence.
};

struct Needs {
    Need shadow_rays;    ///< Direct light from lights of area.
    Need specular_rays;  ///< Mirror reflection and refraction; without them no path makes a caustic.
    Need glossy_lobes;   ///< Blinn-Phong lobes in gathers and estimates: queries need their direction.

    std::array<const Need*, 3> list() const& { return {&shadow_rays, &specular_rays, &glossy_lobes}; }
    std::array<const Need*, 3> list() && = delete;  // Would point into what is gone.
};

/// Looks at the materials that triangles bear, not at those that are only named.
Needs needs_of(const Scene& scene);

}  // namespace regather::scenes
