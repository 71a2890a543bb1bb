// scenes/needs.h -- what a scene needs of a capture, derived from what is in it. The rest is left out: not
// traced, not stored, not replayed. The reasons are for the terminal and for trace.json.
#pragma once
#include <array>
#include <set>
#include <string>
#include <string_view>

#include "scenes/scene.h"

namespace regather::scenes {

struct Need {
    std::string_view part;  ///< As users see it: "shadow_rays".
    bool needed = false;
    std::string reason;       ///< One sentence.
    bool can_be_kept = true;  ///< There is something to build when it is not needed.
};

struct Needs {
    Need shadow_rays;    ///< Direct light from lights of area.
    Need specular_rays;  ///< Mirror reflection and refraction.
    Need caustics;  ///< The caustic photon map: lights of area and specular surfaces that may gather their
                    ///< light.
    Need glossy_lobes;  ///< Blinn-Phong lobes in gathers and estimates: queries need their direction.
    Need camera_path;   ///< Frames other than the standing camera's.

    /// Says of these parts that they are needed. Throws trace::UsageError for a name that is no part's that
    /// can be kept.
    void keep(const std::set<std::string>& parts);

    std::array<const Need*, 5> list() const& {
        return {&shadow_rays, &specular_rays, &caustics, &glossy_lobes, &camera_path};
    }
    std::array<const Need*, 5> list() && = delete;  // Would point into what is gone.
};

/// Looks at the materials that triangles bear, not at those that are only named.
Needs needs_of(const Scene& scene);

}  // namespace regather::scenes
