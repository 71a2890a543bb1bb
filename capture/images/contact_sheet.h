// capture/images/contact_sheet.h -- several scenes in one picture: a small rendering of each with its name
// below.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "capture/images/image.h"
#include "scenes/scene.h"

namespace regather::capture {

struct ContactSheetConfig {
    std::uint32_t columns = 4, edge = 160;  ///< Renderings a row; width and height of each [pixels].
    std::uint32_t photons = 100'000, gather_rays = 8, shadow_rays = 4, k = 50;
};

/// Each scene by its standing camera at its own middle exposure, in the order given, row by row from the top
/// left; display values in [0, 1], to be written with Tone::linear. A name that is wider than its rendering
/// is cut. Throws trace::UsageError when there is no scene.
Image contact_sheet(std::span<const scenes::Scene> all, const ContactSheetConfig& config,
                    const std::function<void(std::string_view scene, std::size_t done)>& progress = {});

}  // namespace regather::capture
