// scenes/catalogue.h -- the scenes that are part of the binary: scenes/embedded/*.json, one row each.
#pragma once
#include <span>
#include <string_view>

namespace regather::scenes {

struct EmbeddedScene {
    std::string_view name;     ///< What load_scene is asked for.
    std::string_view summary;  ///< One line.
    std::string_view text;     ///< The JSON file.
};

/// The one table of embedded scenes.
std::span<const EmbeddedScene> catalogue();

}  // namespace regather::scenes
