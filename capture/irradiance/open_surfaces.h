// capture/irradiance/open_surfaces.h -- whether a scene is one for records of irradiance: how much of what
// the camera sees are diffuse surfaces that go on as they are.
#pragma once
#include <cstdint>
#include <string>

#include "scenes/scene.h"

namespace regather::capture {

/// Of 64 x 64 rays from the scene's standing camera.
struct OpenSurfaces {
    std::uint32_t met = 0;      ///< Rays that meet something.
    std::uint32_t diffuse = 0;  ///< Rays that meet a diffuse material first.
    /// Those of them whose neighbours to the right and below do, too, with normals within 15 degrees, and
    /// within a fifth of their distance of the surface's plane.
    std::uint32_t open = 0;

    /// Half of what is met is open: a record serves its neighbours there.
    bool suited() const { return 2 * std::uint64_t{open} >= met && met > 0; }
    std::string text() const;  ///< One sentence.
};
OpenSurfaces open_surfaces(const scenes::Scene& scene);

}  // namespace regather::capture
