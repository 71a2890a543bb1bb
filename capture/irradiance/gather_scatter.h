// capture/irradiance/gather_scatter.h -- how far apart gathers begin that follow one another.
#pragma once
#include <cstdint>
#include <span>

#include "capture/irradiance/irradiance_seeding.h"

namespace regather::capture {

/// Of a picture's tiles: the mean distance from one origin of gather rays to the next of the tile, row by
/// row, over the diagonal of the box about all points of the tile; the mean over tiles with two origins or
/// more whose box has a diagonal. 0 where there are none. `is_origin` by point, `tile` [pixels] at least 1; a
/// row's points are in order.
double gather_scatter(std::span<const SeedPoint> points, std::span<const std::uint8_t> is_origin,
                      std::uint32_t tile);

}  // namespace regather::capture
