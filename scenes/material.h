// scenes/material.h -- materials of a scene file, from their JSON.
#pragma once
#include <string>

#include "scenes/document.h"
#include "scenes/scene.h"

namespace regather::scenes {

/// Refuses one that reflects more than it gets.
Material read_material(const std::string& name, const Node& node);

}  // namespace regather::scenes
