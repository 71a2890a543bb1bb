// imports/maps/entity_keys.h -- which entities of a map are used, and which of their keys; all others are
// counted.
#pragma once
#include <span>

#include "imports/left_out.h"
#include "imports/maps/bsp.h"

namespace regather::imports {

/// Classes that are not used, and keys of those that are. Of whatever has a model of the map (doors,
/// platforms) the faces are taken where it stands.
void count_left_out(std::span<const BspEntity> entities, LeftOut& left_out);

}  // namespace regather::imports
