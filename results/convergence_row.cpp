#include "results/convergence_row.h"

namespace regather::results {
namespace {

constexpr Column convergence_columns[] = {
    column<&ConvergenceRow::scene>("scene"),
    column<&ConvergenceRow::reference>("reference"),
    column<&ConvergenceRow::ladder, ConvergenceRow>("ladder", needed),
    column<&ConvergenceRow::mode, ConvergenceRow>("mode", needed),
    column<&ConvergenceRow::gather_rays, ConvergenceRow>("gather_rays"),
    column<&ConvergenceRow::photons, ConvergenceRow>("photons"),
    column<&ConvergenceRow::k, ConvergenceRow>("k"),
    column<&ConvergenceRow::radius, ConvergenceRow>("radius"),
    column<&ConvergenceRow::caustic_photons, ConvergenceRow>("caustic_photons"),
    column<&ConvergenceRow::samples, ConvergenceRow>("samples"),
    column<&ConvergenceRow::sampling, ConvergenceRow>("sampling"),
    column<&ConvergenceRow::irradiance_cache, ConvergenceRow>("irradiance_cache"),
    column<&ConvergenceRow::precompute_every, ConvergenceRow>("precompute_every"),
    column<&ConvergenceRow::reverse_pixels, ConvergenceRow>("reverse_pixels"),
    column<&ConvergenceRow::photon_seed, ConvergenceRow>("photon_seed"),
    column<&ConvergenceRow::shadow_rays>("shadow_rays"),
    column<&ConvergenceRow::width>("width"),
    column<&ConvergenceRow::height>("height"),
    column<&ConvergenceRow::seeds>("seeds"),
    column<&ConvergenceRow::render_seconds>("render_seconds", Form::seconds),
    column<&ConvergenceRow::photon_seconds>("photon_seconds", Form::seconds),
    column<&ConvergenceRow::tree_seconds>("tree_seconds", Form::seconds),
    column<&ConvergenceRow::total_seconds>("total_seconds", Form::seconds, needed),
    column<&ConvergenceRow::pixels>("pixels"),
    column<&ConvergenceRow::rmse>("rmse", needed),
    column<&ConvergenceRow::below_reference>("below_reference"),
    column<&ConvergenceRow::rel_mse>("rel_mse"),
    column<&ConvergenceRow::rel_mse_trimmed>("rel_mse_trimmed"),
    column<&ConvergenceRow::mape>("mape"),
    column<&ConvergenceRow::ldr_flip>("ldr_flip"),
    column<&ConvergenceRow::hdr_flip>("hdr_flip"),
    column<&ConvergenceRow::variance>("variance"),
    column<&ConvergenceRow::variance_stderr>("variance_stderr"),
    column<&ConvergenceRow::indirect_variance>("indirect_variance"),
    column<&ConvergenceRow::indirect_variance_stderr>("indirect_variance_stderr"),
    column<&ConvergenceRow::bias_squared>("bias_squared", Form::signed_real),
    column<&ConvergenceRow::bias_squared_stderr>("bias_squared_stderr"),
    column<&ConvergenceRow::interior_variance>("interior_variance"),
    column<&ConvergenceRow::interior_bias_squared>("interior_bias_squared", Form::signed_real),
    column<&ConvergenceRow::interior_bias_squared_stderr>("interior_bias_squared_stderr"),
    column<&ConvergenceRow::interior_pixels>("interior_pixels"),
    column<&ConvergenceRow::interior_radius>("interior_radius"),
    column<&ConvergenceRow::interior_mean_radiance>("interior_mean_radiance"),
    column<&ConvergenceRow::efficiency>("efficiency"),
    column<&ConvergenceRow::mean_radiance>("mean_radiance"),
    column<&ConvergenceRow::reference_rmse>("reference_rmse"),
    column<&ConvergenceRow::nonfinite>("nonfinite"),
};

constexpr Column ladder_columns[] = {
    column<&LadderRow::ladder>("ladder", needed),
    column<&LadderRow::mode>("mode"),
    column<&LadderRow::gather_rays>("gather_rays"),
    column<&LadderRow::photons>("photons"),
    column<&LadderRow::k>("k"),
    column<&LadderRow::radius>("radius"),
    column<&LadderRow::caustic_photons>("caustic_photons"),
    column<&LadderRow::samples>("samples"),
    column<&LadderRow::sampling>("sampling"),
    column<&LadderRow::irradiance_cache>("irradiance_cache"),
    column<&LadderRow::precompute_every>("precompute_every"),
    column<&LadderRow::reverse_pixels>("reverse_pixels"),
    column<&LadderRow::photon_seed>("photon_seed"),
};

}  // namespace

const RowKind& ConvergenceRow::kind() {
    static constexpr RowKind kind{"convergence", convergence_columns};
    return kind;
}
const RowKind& LadderRow::kind() {
    static constexpr RowKind kind{"ladder", ladder_columns};
    return kind;
}

}  // namespace regather::results
