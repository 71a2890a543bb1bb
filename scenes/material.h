// scenes/material.h -- materials of a scene file, from their JSON.
#pragma once
#include <string>

#include "scenes/keys.h"
#include "scenes/scene.h"

namespace regather::scenes {

/// Refuses one that reflects more than it gets.
Material read_material(const std::string& name, const Field& node);

}  // namespace regather::scenes
