// scenes/loader.h -- scene files in, scenes out. The format: docs/scene_format.md.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "meshes/surface.h"
#include "scenes/scene.h"

namespace regather::scenes {

/// More triangles than this are refused before any is made.
using meshes::most_triangles;

/// An embedded scene's name (scenes/catalogue.h), else the path of a JSON file. Throws trace::DataError, one
/// line "FILE: FIELD: found X, expected Y", for anything wrong in the file or in a mesh it names;
/// trace::UsageError for a bare word that is neither an embedded scene nor a file, and for a mesh file.
Scene load_scene(std::string_view name_or_path);

/// The scene that `text` (JSON) describes. `file` names it in errors; meshes are looked up in `directory`.
Scene parse_scene(std::string_view text, const std::string& file, const std::filesystem::path& directory);

}  // namespace regather::scenes
