// imports/maps/entity_keys.h -- which entities of a map are used, and which of their keys; all others are
// counted.
#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "imports/left_out.h"
#include "imports/maps/bsp.h"

namespace regather::imports {

/// Classes that are not used, and keys of those that are. Of whatever has a model of the map (doors,
/// platforms) the faces are taken where it stands.
void count_left_out(std::span<const BspEntity> entities, LeftOut& left_out);

/// The three numbers that the text begins with, blanks between them: an origin, say. Nothing for less, or for
/// one beyond 1e6.
std::optional<trace::Vec3> triple_in(std::string_view text);

}  // namespace regather::imports
