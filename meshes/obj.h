// meshes/obj.h -- whether an OBJ file and its MTL libraries are sound (Wavefront, "Object Files (.obj)",
// appendices B1 and B2). Assimp trusts some of what it reads there, so that both are checked before Assimp
// sees them.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace regather::scenes {

struct ObjContents {
    std::string damage;                  ///< "" when sound, else what was found, in a few words.
    std::vector<std::string> libraries;  ///< The names after mtllib.
};

/// Sound: every vertex has three finite numbers, and points, lines and faces name only vertices, texture
/// coordinates and normals that are in the file. Keywords of curves and surfaces are passed over, as Assimp
/// does.
ObjContents check_obj(std::string_view bytes);

/// "" for a library whose numbers are finite and stand behind a newmtl; else what was found.
std::string mtl_damage(std::string_view bytes);

}  // namespace regather::scenes
