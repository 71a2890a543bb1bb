// study/ladder.h -- ladders of settings: each varies one thing in geometric steps and holds the rest.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "capture/query_pass.h"

namespace regather::study {

struct Setting {
    std::string ladder;
    capture::Visualisation mode = capture::Visualisation::final_gather;
    std::uint32_t gather_rays = 16, photons = 50'000, k = 50;
    double radius = std::numeric_limits<double>::infinity();  ///< [scene units]
    std::uint32_t caustic_photons = 50'000, samples = 4;
    std::string sampling;          ///< Spec with all parameters; empty: the default strategy.
    std::string irradiance_cache;  ///< Spec with all parameters; empty: none.
    std::uint32_t precompute_every = 0, reverse_pixels = 0;  ///< As in CaptureConfig; 0: not.
    /// All images have the photons of this seed, so that they differ by what pixels draw alone; none: each
    /// has its own.
    std::optional<std::uint64_t> photon_seed;

    friend bool operator==(const Setting&, const Setting&) = default;
};

std::string_view mode_name(capture::Visualisation mode);  ///< "final-gather", "direct"

/// gather-rays, photons, k, radius and samples with final gathers; direct-photons (k held), direct-k (photons
/// held) and direct-both (k with the root of the photons) without; with `caustics`, caustic-photons, too,
/// else settings have none. `diagonal`: of the scene's box, for the radii.
std::vector<Setting> default_ladder(double diagonal, bool caustics);

/// A table in CSV: a header with names of Setting's fields, a line a setting; what has no column stays at its
/// default. mode: final-gather or direct; an empty radius: none; sampling and irradiance_cache: specs.
/// trace::DataError names file, line and column.
std::vector<Setting> parse_ladder(std::string_view text, std::string_view file);

}  // namespace regather::study
