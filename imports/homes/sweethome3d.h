// imports/homes/sweethome3d.h -- Sweet Home 3D homes as scenes: a .sh3d file (a zip with Home.xml), or an
// archive that has homes as XML among other things, as the examples in sweethome3d.jar. What is taken over,
// and what is not: docs/import.md.
#pragma once
#include <filesystem>
#include <string>

#include "imports/scene_file.h"

namespace regather::imports {

inline constexpr std::uint64_t most_home_bytes = 64u << 20;       ///< Of the XML.
inline constexpr std::uint64_t most_home_triangles = 20'000'000;  ///< Of all walls and furniture together.

/// `home`: "Home" of a .sh3d file, "Studio" of ".../examples/Studio.xml"; it may be empty when the archive
/// has one. Throws trace::DataError for a damaged archive or home; trace::UsageError for a home that it does
/// not have, naming the nearest.
ImportedScene import_sweethome3d(const std::filesystem::path& archive, const std::string& home);

}  // namespace regather::imports
