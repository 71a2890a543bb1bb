// capture/baselines/precomputed_irradiance.h -- irradiance estimated at photons before anything is gathered
// (Christensen, "Faster Photon Map Global Illumination", Journal of Graphics Tools 4(3), 1999): a gather then
// reads one record in place of k photons.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "capture/gather_pass.h"
#include "trace/folder.h"

namespace regather::capture {

struct PrecomputedIrradiance {
    /// Photons in the heap order of left_balanced() whose power is the irradiance of the side that they lie
    /// on [W / m^2]; theta and phi are 0.
    std::vector<trace::Photon> records;
    Searched searches;            ///< One a record, at photons 0, every, 2 every ...
    std::uint64_t nonfinite = 0;  ///< Estimates that were left out; such a record is black.
};

/// At photons 0, every, 2 every ... of `heap`, with config's k, radius and filter. The photon itself is one
/// of the k; it stands for the one that is missing, on average, in the empty disc about a point whose nearest
/// it is. `every` is above 0.
PrecomputedIrradiance precompute_irradiance(std::span<const trace::Photon> heap, std::uint32_t every,
                                            const GatherConfig& config);

/// Reflectance times the irradiance of the nearest record within config.radius, with config.surface_check
/// the nearest whose surface faces as the query's does, over pi; 0 where there is none. A glossy surface
/// reflects as a diffuse one of the sum of its reflectances. `order` as gather() has it.
void look_up(const Scene& scene, std::span<const trace::Photon> records, const Queries& queries,
             std::span<const std::uint32_t> order, const GatherConfig& config, Gathered& gathered);

/// Searches at photons 0, every, 2 every ... of `heap` as a trace: its columns, and what trace.json says of
/// them.
void write_photon_searches(trace::TraceWriter& writer, std::span<const trace::Photon> heap,
                           std::uint32_t every, const Searched& searches, trace::TraceInfo& info);

}  // namespace regather::capture
