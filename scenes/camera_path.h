// scenes/camera_path.h -- the camera at a frame of a scene's camera path.
#pragma once
#include <cstdint>

#include "scenes/scene.h"

namespace regather::scenes {

/// Position and target on cubic Hermite curves through the key frames (tangents by central differences over
/// frame numbers, Catmull & Rom 1974 when the keys are evenly spaced), `up` turned evenly between them; the
/// field of view is the scene camera's. Throws trace::UsageError when `frame` is not below scene.frames, or
/// the scene has no path.
Camera camera_at(const Scene& scene, std::uint32_t frame);

}  // namespace regather::scenes
