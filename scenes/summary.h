// scenes/summary.h -- a scene in a few words and sums, for people.
#pragma once
#include <span>
#include <string>

#include "scenes/scene.h"

namespace regather::scenes {

/// "3 diffuse, 1 glossy": how many there are of each kind that there is.
std::string kinds_of(std::span<const Material> materials);

/// What all lights emit [W], by channel.
Vec3 total_power(const Scene& scene);

}  // namespace regather::scenes
