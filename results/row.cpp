#include "results/row.h"

namespace regather::results {
namespace {

constexpr Column measurement_columns[] = {
    column<&Row::scene>("scene"),
    column<&Row::frame>("frame"),
    column<&Row::ordering>("ordering", Form::name, needed),
    column<&Row::tile>("tile"),
    column<&Row::bins>("bins"),
    column<&Row::structure>("structure"),
    column<&Row::layout>("layout"),
    column<&Row::policy>("policy"),
    column<&Row::cache_bytes>("cache_bytes", needed),
    column<&Row::line_bytes>("line_bytes", needed),
    column<&Row::ways>("ways", Form::ways, needed),
    column<&Row::queries>("queries"),
    column<&Row::accesses>("accesses"),
    column<&Row::raw_bytes>("raw_bytes"),
    column<&Row::oracle_bytes>("oracle_bytes"),
    column<&Row::compulsory_bytes>("compulsory_bytes"),
    column<&Row::misses>("misses"),
    column<&Row::traffic_bytes>("traffic_bytes", needed),
    column<&Row::reorder_bytes>("reorder_bytes"),
    column<&Row::key_ops>("key_ops"),
    column<&Row::moved_records>("moved_records"),
    column<&Row::buffered_bytes>("buffered_bytes"),
    column<&Row::recast_rays>("recast_rays"),
    column<&Row::order_seconds>("order_seconds", Form::seconds),
    column<&Row::replay_seconds>("replay_seconds", Form::seconds),
    column<&Row::parameters>("parameters"),
    column<&Row::keys>("keys"),
    column<&Row::sort_passes>("sort_passes"),
    column<&Row::stalls>("stalls"),
    column<&Row::compulsory>("compulsory"),
    column<&Row::capacity>("capacity"),
    column<&Row::conflict>("conflict"),
    column<&Row::writebacks>("writebacks"),
    column<&Row::onchip_bytes>("onchip_bytes"),
    column<&Row::buffer_traffic_bytes>("buffer_traffic_bytes"),
    column<&Row::net_benefit_bytes>("net_benefit_bytes"),
    column<&Row::set_sampling>("set_sampling"),
    column<&Row::sampled_sets>("sampled_sets"),
    column<&Row::misses_stderr>("misses_stderr"),
    column<&Row::misses_low>("misses_low"),
    column<&Row::misses_high>("misses_high"),
    column<&Row::sampling>("sampling"),
    column<&Row::irradiance_cache>("irradiance_cache"),
};

}  // namespace

const RowKind& Row::kind() {
    static constexpr RowKind kind{"measurement", measurement_columns};
    return kind;
}

}  // namespace regather::results
