// tests/results/settings.h -- settings of the renderer made by hand.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "results/convergence_row.h"

namespace regather::results {

/// Of mean radiance 2; half of the seconds are for rendering.
inline ConvergenceRow made_setting(std::string ladder, std::string mode, std::uint64_t photons,
                                   std::uint64_t k, double seconds, double rmse) {
    ConvergenceRow row;
    row.scene = "box";
    row.reference = "r";
    row.ladder = std::move(ladder);
    row.mode = std::move(mode);
    row.photons = photons;
    row.k = k;
    row.width = row.height = 8;
    row.seeds = 4;
    row.total_seconds = seconds;
    row.render_seconds = seconds / 2;
    row.rmse = rmse;
    row.mean_radiance = row.interior_mean_radiance = 2;
    row.reference_rmse = 0.01;
    row.variance = row.interior_variance = rmse * rmse;
    row.efficiency = 1 / (rmse * rmse * seconds);
    return row;
}

/// Error falls with the root of the time.
inline std::vector<ConvergenceRow> square_root() {
    return {made_setting("photons", "final-gather", 100, 10, 4, 0.1),
            made_setting("photons", "final-gather", 10, 10, 1, 0.2),
            made_setting("photons", "final-gather", 1000, 10, 16, 0.05)};
}

}  // namespace regather::results
