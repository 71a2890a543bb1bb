// results/convergence_row.h -- one setting of the renderer: how long it took and how far its images were from
// the reference, over several seeds; and a step of a ladder, which is a setting to be measured.
#pragma once
#include <string>

#include "results/column.h"

namespace regather::results {

/// Empty: as the program's defaults have it.
struct LadderRow {
    static const RowKind& kind();

    std::string ladder;  ///< What is varied: "photons".
    std::string mode;    ///< "final-gather" or "direct"
    Count gather_rays, photons, k;
    Number radius;  ///< Maximum radius of a gather [scene units]; empty: none.
    Count caustic_photons, samples;
    std::string sampling;          ///< Of gather rays: a strategy's spec.
    std::string irradiance_cache;  ///< A metric's spec; empty: none.
    Count precompute_every;        ///< Irradiance is precomputed at every so many photons; empty: gathered.
    Count reverse_pixels;  ///< Photons search the hit points of so many pixels; empty: the other way round.
    Count photon_seed;     ///< All images have photons of this seed; empty: each its own.
};

struct ConvergenceRow : LadderRow {
    static const RowKind& kind();

    std::string scene, reference;  ///< Reference: checksum of its pixels.
    Count shadow_rays, width, height;
    Count seeds;            ///< Images rendered; all that follows is a mean over them.
    Number render_seconds;  ///< Queries and gathers.
    Number photon_seconds, tree_seconds;
    Number total_seconds;  ///< The three together.
    Count pixels;          ///< That count for RMSE, bias and variance: no lights and their edges.
    Number rmse;           ///< [W / (m^2 sr)] The reference's own error is taken off.
    Flag below_reference;  ///< `rmse` is not told apart from the reference's error, which stands there.
    Number rel_mse, rel_mse_trimmed, mape, ldr_flip,
        hdr_flip;     ///< As measured: with the reference's error in them.
    Number variance;  ///< Mean over pixels and channels [(W / (m^2 sr))^2].
    Number variance_stderr;
    Number indirect_variance, indirect_variance_stderr;  ///< Of what gather rays bring alone.
    Number bias_squared;  ///< Estimate without bias of its own: around 0 it may be negative.
    Number bias_squared_stderr;
    Number interior_variance, interior_bias_squared,
        interior_bias_squared_stderr;  ///< Away from edges of surfaces ...
    Count interior_pixels;             ///< ... in so many pixels ...
    Number interior_radius,
        interior_mean_radiance;            ///< ... so far from them, of so much radiance in the reference.
    Number efficiency;                     ///< 1 / (variance x total seconds)
    Number mean_radiance, reference_rmse;  ///< Of the reference; its error as its own variance tells.
    Count nonfinite;                       ///< Values that were no numbers, over all images.
};

}  // namespace regather::results
