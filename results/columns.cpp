#include "results/csv.h"

namespace regather::results {
namespace {

constexpr bool needed = true;

constexpr Column<Row> measurement_columns[] = {
    {"scene", &Row::scene},
    {"frame", &Row::frame},
    {"ordering", &Row::ordering, needed},
    {"tile", &Row::tile},
    {"bins", &Row::bins},
    {"structure", &Row::structure},
    {"layout", &Row::layout},
    {"policy", &Row::policy},
    {"cache_bytes", &Row::cache_bytes, needed},
    {"line_bytes", &Row::line_bytes, needed},
    {"ways", Ways<Row>{&Row::ways}, needed},
    {"queries", &Row::queries},
    {"accesses", &Row::accesses},
    {"raw_bytes", &Row::raw_bytes},
    {"oracle_bytes", &Row::oracle_bytes},
    {"compulsory_bytes", &Row::compulsory_bytes},
    {"misses", &Row::misses},
    {"traffic_bytes", &Row::traffic_bytes, needed},
    {"reorder_bytes", &Row::reorder_bytes},
    {"key_ops", &Row::key_ops},
    {"moved_records", &Row::moved_records},
    {"buffered_bytes", &Row::buffered_bytes},
    {"recast_rays", &Row::recast_rays},
    {"order_seconds", Seconds<Row>{&Row::order_seconds}},
    {"replay_seconds", Seconds<Row>{&Row::replay_seconds}},
    {"parameters", &Row::parameters},
    {"keys", &Row::keys},
    {"sort_passes", &Row::sort_passes},
    {"stalls", &Row::stalls},
    {"compulsory", &Row::compulsory},
    {"capacity", &Row::capacity},
    {"conflict", &Row::conflict},
    {"writebacks", &Row::writebacks},
    {"onchip_bytes", &Row::onchip_bytes},
    {"buffer_traffic_bytes", &Row::buffer_traffic_bytes},
    {"net_benefit_bytes", &Row::net_benefit_bytes},
    {"set_sampling", &Row::set_sampling},
    {"sampled_sets", &Row::sampled_sets},
    {"misses_stderr", Real<Row>{&Row::misses_stderr}},
    {"misses_low", &Row::misses_low},
    {"misses_high", &Row::misses_high},
};

constexpr Column<DetailRow> detail_columns[] = {
    {"scene", &DetailRow::scene},
    {"ordering", &DetailRow::ordering, needed},
    {"tile", &DetailRow::tile},
    {"bins", &DetailRow::bins},
    {"parameters", &DetailRow::parameters},
    {"layout", &DetailRow::layout},
    {"policy", &DetailRow::policy},
    {"cache_bytes", &DetailRow::cache_bytes, needed},
    {"line_bytes", &DetailRow::line_bytes, needed},
    {"ways", Ways<DetailRow>{&DetailRow::ways}, needed},
    {"region", &DetailRow::region, needed},
    {"tree_depth", &DetailRow::tree_depth, needed},
    {"accesses", &DetailRow::accesses},
    {"misses", &DetailRow::misses, needed},
    {"compulsory", &DetailRow::compulsory},
    {"capacity", &DetailRow::capacity},
    {"conflict", &DetailRow::conflict},
    {"traffic_bytes", &DetailRow::traffic_bytes},
    {"used_bytes", &DetailRow::used_bytes},
};

constexpr Column<TimelineRow> timeline_columns[] = {
    {"scene", &TimelineRow::scene},
    {"ordering", &TimelineRow::ordering, needed},
    {"tile", &TimelineRow::tile},
    {"bins", &TimelineRow::bins},
    {"parameters", &TimelineRow::parameters},
    {"cache_bytes", &TimelineRow::cache_bytes, needed},
    {"line_bytes", &TimelineRow::line_bytes, needed},
    {"ways", Ways<TimelineRow>{&TimelineRow::ways}, needed},
    {"slice", &TimelineRow::slice, needed},
    {"first_query", &TimelineRow::first_query, needed},
    {"queries", &TimelineRow::queries, needed},
    {"accesses", &TimelineRow::accesses},
    {"misses", &TimelineRow::misses, needed},
};

constexpr Column<SamplingRow> sampling_columns[] = {
    {"scene", &SamplingRow::scene},
    {"ordering", &SamplingRow::ordering, needed},
    {"parameters", &SamplingRow::parameters},
    {"cache_bytes", &SamplingRow::cache_bytes, needed},
    {"line_bytes", &SamplingRow::line_bytes, needed},
    {"ways", Ways<SamplingRow>{&SamplingRow::ways}, needed},
    {"set_sampling", &SamplingRow::set_sampling, needed},
    {"seed", &SamplingRow::seed},
    {"misses", &SamplingRow::misses, needed},
    {"misses_stderr", Real<SamplingRow>{&SamplingRow::misses_stderr}},
    {"misses_low", &SamplingRow::misses_low},
    {"misses_high", &SamplingRow::misses_high},
    {"exact_misses", &SamplingRow::exact_misses, needed},
    {"covered", &SamplingRow::covered},
    {"seconds", Seconds<SamplingRow>{&SamplingRow::seconds}, needed},
    {"exact_seconds", Seconds<SamplingRow>{&SamplingRow::exact_seconds}},
};

using C = ConvergenceRow;
constexpr Column<C> convergence_columns[] = {
    {"scene", &C::scene},
    {"reference", &C::reference},
    {"ladder", &C::ladder, needed},
    {"mode", &C::mode, needed},
    {"gather_rays", &C::gather_rays},
    {"photons", &C::photons},
    {"k", &C::k},
    {"radius", Real<C>{&C::radius}},
    {"caustic_photons", &C::caustic_photons},
    {"samples", &C::samples},
    {"shadow_rays", &C::shadow_rays},
    {"width", &C::width},
    {"height", &C::height},
    {"seeds", &C::seeds},
    {"render_seconds", Seconds<C>{&C::render_seconds}},
    {"photon_seconds", Seconds<C>{&C::photon_seconds}},
    {"tree_seconds", Seconds<C>{&C::tree_seconds}},
    {"total_seconds", Seconds<C>{&C::total_seconds}, needed},
    {"pixels", &C::pixels},
    {"rmse", Real<C>{&C::rmse}, needed},
    {"below_reference", &C::below_reference},
    {"rel_mse", Real<C>{&C::rel_mse}},
    {"rel_mse_trimmed", Real<C>{&C::rel_mse_trimmed}},
    {"mape", Real<C>{&C::mape}},
    {"ldr_flip", Real<C>{&C::ldr_flip}},
    {"hdr_flip", Real<C>{&C::hdr_flip}},
    {"variance", Real<C>{&C::variance}},
    {"bias_squared", SignedReal<C>{&C::bias_squared}},
    {"bias_squared_stderr", Real<C>{&C::bias_squared_stderr}},
    {"interior_variance", Real<C>{&C::interior_variance}},
    {"interior_bias_squared", SignedReal<C>{&C::interior_bias_squared}},
    {"interior_bias_squared_stderr", Real<C>{&C::interior_bias_squared_stderr}},
    {"interior_pixels", &C::interior_pixels},
    {"interior_radius", Real<C>{&C::interior_radius}},
    {"interior_mean_radiance", Real<C>{&C::interior_mean_radiance}},
    {"efficiency", Real<C>{&C::efficiency}},
    {"mean_radiance", Real<C>{&C::mean_radiance}},
    {"reference_rmse", Real<C>{&C::reference_rmse}},
    {"nonfinite", &C::nonfinite},
};

constexpr Column<StabilityRow> stability_columns[] = {
    {"group", &StabilityRow::group, needed},
    {"case", &StabilityRow::stability_case, needed},
    {"quantity", &StabilityRow::quantity},
    {"error", Real<StabilityRow>{&StabilityRow::error}, needed},
    {"allowed_error", Real<StabilityRow>{&StabilityRow::allowed_error}, needed},
    {"passed", &StabilityRow::passed},
    {"seconds", Seconds<StabilityRow>{&StabilityRow::seconds}},
    {"reason", &StabilityRow::reason},
};

constexpr Column<LadderRow> ladder_columns[] = {
    {"ladder", &LadderRow::ladder, needed},
    {"mode", &LadderRow::mode},
    {"gather_rays", &LadderRow::gather_rays},
    {"photons", &LadderRow::photons},
    {"k", &LadderRow::k},
    {"radius", Real<LadderRow>{&LadderRow::radius}},
    {"caustic_photons", &LadderRow::caustic_photons},
    {"samples", &LadderRow::samples},
};

}  // namespace

template <>
std::span<const Column<Row>> columns() {
    return measurement_columns;
}
template <>
std::span<const Column<DetailRow>> columns() {
    return detail_columns;
}
template <>
std::span<const Column<TimelineRow>> columns() {
    return timeline_columns;
}
template <>
std::span<const Column<SamplingRow>> columns() {
    return sampling_columns;
}
template <>
std::span<const Column<ConvergenceRow>> columns() {
    return convergence_columns;
}
template <>
std::span<const Column<StabilityRow>> columns() {
    return stability_columns;
}
template <>
std::span<const Column<LadderRow>> columns() {
    return ladder_columns;
}

}  // namespace regather::results
