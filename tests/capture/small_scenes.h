// tests/capture/small_scenes.h -- scenes whose light is known without a renderer.
#pragma once
#include <fmt/format.h>

#include <string>

#include "scenes/loader.h"

namespace regather::capture {

/// A box of 1 m whose six walls have the albedo, with a small light under the ceiling that faces down.
/// `open`: without floor.
inline scenes::Scene closed_box(double albedo, bool open = false) {
    std::string walls;
    const auto wall = [&](const char* corner, const char* u, const char* v) {
        walls += fmt::format(
            R"({}{{"type": "quad", "material": "wall", "corner": {}, "edge_u": {}, "edge_v": {}}})",
            walls.empty() ? "" : ", ", corner, u, v);
    };
    if (!open) wall("[0, 0, 0]", "[1, 0, 0]", "[0, 1, 0]");
    wall("[0, 0, 1]", "[0, 1, 0]", "[1, 0, 0]");
    wall("[0, 0, 0]", "[0, 0, 1]", "[1, 0, 0]");
    wall("[0, 1, 0]", "[1, 0, 0]", "[0, 0, 1]");
    wall("[0, 0, 0]", "[0, 1, 0]", "[0, 0, 1]");
    wall("[1, 0, 0]", "[0, 0, 1]", "[0, 1, 0]");
    return scenes::parse_scene(
        fmt::format(R"({{"name": "closed", "camera": {{"position": [0.5, 0.1, 0.5], "target": [0.5, 1, 0.4],
                         "up": [0, 0, 1], "vertical_fov_degrees": 60}},
                         "materials": {{"wall": {{"kind": "diffuse", "diffuse": [{0}, {0}, {0}]}}}},
                         "shapes": [{1}],
                         "lights": [{{"corner": [0.4, 0.4, 0.999], "edge_u": [0, 0.2, 0], "edge_v": [0.2, 0, 0],
                                      "power": [3, 2, 1]}}]}})",
                    albedo, walls),
        "closed.json", ".");
}

/// A floor at z = 0, a light of 1 x 1 m at z = 1 above its centre facing down, and a camera that looks at the
/// floor's centre.
inline scenes::Scene light_over_floor() {
    return scenes::parse_scene(
        R"({"name": "floor", "camera": {"position": [0.9, 0, 0.5], "target": [0, 0, 0], "up": [0, 0, 1],
                                          "vertical_fov_degrees": 0.01},
            "materials": {"floor": {"kind": "diffuse", "diffuse": [0.8, 0.4, 0.2]}},
            "shapes": [{"type": "quad", "material": "floor", "corner": [-5, -5, 0], "edge_u": [10, 0, 0],
                        "edge_v": [0, 10, 0]}],
            "lights": [{"corner": [-0.5, -0.5, 1], "edge_u": [0, 1, 0], "edge_v": [1, 0, 0], "radiance": [10, 10, 10]}]})",
        "floor.json", ".");
}

}  // namespace regather::capture
