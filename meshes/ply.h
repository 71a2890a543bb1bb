// meshes/ply.h -- whether a PLY file is whole (Turk, "The PLY Polygon File Format", 1994; ASCII and both
// binary forms). Assimp 5.2.5 loops for ever on a header that is cut, so a file is checked before Assimp
// sees it.
#pragma once
#include <string>
#include <string_view>

namespace regather::scenes {

/// "" for a file whose header is sound, whose elements are all there, whose numbers are finite and whose
/// faces name only vertices that exist; else what was found, in a few words. Bytes after the last element do
/// not matter.
std::string ply_damage(std::string_view bytes);

}  // namespace regather::scenes
