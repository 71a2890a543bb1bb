// imports/furniture/demonstration.h -- a global illumination demonstration out of Debian's
// sweethome3d-furniture: glassware, a bottle and a chessboard on an oak table in a small room. The models and
// where they stand are a table in the .cpp file.
#pragma once
#include <filesystem>
#include <span>

#include "imports/scene_file.h"

namespace regather::imports {

/// `catalogues` are .sh3f files, or folders of them. Authors and licences of the models used stand in the
/// scene. Throws trace::DataError when a catalogue is damaged, or none has one of the models.
ImportedScene import_furniture(std::span<const std::filesystem::path> catalogues);

}  // namespace regather::imports
