// scenes/keys.h -- which keys each object of a scene file may have: the one table that the loader checks
// against. docs/scene_format.md explains the same keys to people.
#pragma once
#include <span>
#include <string_view>

#include "trace/field.h"

namespace regather::scenes {

using trace::Field, trace::Key, trace::Kind;

const Kind& scene_kind();
const Kind& camera_kind();
const Kind& camera_path_kind();
const Kind& key_frame_kind();
/// Told apart by their key "type": rectangle (also without the key), sphere, mesh.
std::span<const Kind> light_kinds();
/// Told apart by their key "type": quad, patch, box, sphere, cylinder, lathe, torus, ripple, terrain,
/// tuft, mesh, instances.
std::span<const Kind> shape_kinds();
const Kind& growth_kind();  ///< In the list `growth` of a terrain.
/// Told apart by their key "kind": diffuse, glossy, mirror, dielectric.
std::span<const Kind> material_kinds();

/// What a key's value has to be, for errors.
inline std::string_view expected(const Kind& kind, std::string_view key) {
    return kind.key(key).expected;
}

}  // namespace regather::scenes
