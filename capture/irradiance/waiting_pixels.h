// capture/irradiance/waiting_pixels.h -- records that take a while to be computed: pixels that one of them
// will serve wait in a local buffer and do not compute it again (the paper's section 6.4: Steinhurst,
// Practical Photon Mapping in Hardware, 2004).
#pragma once
#include <cstdint>
#include <span>

#include "capture/irradiance/irradiance_octree.h"
#include "capture/irradiance/irradiance_seeding.h"

namespace regather::capture {

struct WaitingConfig {
    std::uint32_t latency = 64;  ///< From a record's begin to its end [points].
    std::uint32_t entries = 16;  ///< Of the buffer: points that wait at once; at least 1.
    std::uint32_t tile = 16;     ///< Width and height of the tiles that pixels come in [pixels], at least 1.
};

/// Times are counted in points: one point is looked up a unit of time.
struct WaitingPixels {
    std::uint64_t points = 0;
    std::uint64_t records = 0;         ///< Begun.
    std::uint64_t records_unheld = 0;  ///< Begun without the buffer: those that are made twice, too.
    std::uint64_t waited = 0;          ///< Points that waited in the buffer.
    std::uint64_t most_waiting = 0;    ///< At once.
    std::uint64_t half = 0, nine_tenths = 0, ninety_nine = 0, longest = 0;  ///< Percentiles of the waits.
    std::uint64_t stopped = 0;  ///< Time in which no point was looked up: the buffer was full.
};

/// Points come tile by tile, in a tile row by row. A point that a finished record serves is done. One that a
/// record in the making will serve waits for the earliest of them to end; where the buffer is full, nothing
/// goes on until a place is free. Any other point begins a record, which is finished `latency` later; any
/// number is in the making at once. How far a record will reach is taken to be known when it begins: as far
/// as the record of the octree does that serves its point best (R = 0 where none does), so that nothing is
/// gathered. `box` holds the points.
WaitingPixels waiting_pixels(std::span<const SeedPoint> points, const IrradianceOctree& octree,
                             const trace::Bounds3& box, const WaitingConfig& config);

}  // namespace regather::capture
