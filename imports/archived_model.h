// imports/archived_model.h -- models of furniture in archives: OBJ files with their libraries and textures.
// Materials that no library describes are Java 3D's (imports/java3d_materials.h).
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "imports/archive.h"
#include "imports/model.h"

namespace regather::imports {

/// Of a model, a library or a texture in the archive; more is refused.
inline constexpr std::uint64_t most_model_bytes = 64u << 20;

/// Groups of a model whose faces are window panes or mirrors (Sweet Home 3D names groups so) get these
/// materials.
inline constexpr std::string_view pane_material = "sweethome3d_window_pane",
                                  mirror_material = "sweethome3d_window_mirror";

/// Entry `name` (.obj) of the archive with its libraries. Throws trace::DataError that names archive and
/// entry.
Model read_model(const Zip& zip, const std::string& name);

}  // namespace regather::imports
