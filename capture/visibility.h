// capture/visibility.h -- how much of a scene a camera sees. The paper (section 4.1) asks for scenes of which
// the camera sees less than half: what is not seen still sends light.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "capture/ray_caster.h"
#include "scenes/scene.h"

namespace regather::capture {

inline constexpr std::uint32_t visibility_grid = 256;  ///< Rays along each edge of the picture.

/// For each triangle, whether it is the first that a ray meets through the middle of one of 256 x 256 pixels
/// of a square picture. Mirrors and glass are surfaces like any other here: what is seen in them or through
/// them is not followed.
std::vector<std::uint8_t> triangles_seen(const Scene& scene, const RayCaster& caster,
                                         const scenes::Camera& camera);

/// The area of the triangles that at least one of the cameras sees, over that of all triangles; 0 for no
/// camera.
double share_seen(const Scene& scene, const RayCaster& caster, std::span<const scenes::Camera> cameras);
/// Of the scene's standing camera.
double share_seen(const Scene& scene);
/// Of its camera in all frames of its path.
double share_seen_over_path(const Scene& scene);

}  // namespace regather::capture
