#include "results/sampling_row.h"

namespace regather::results {
namespace {

constexpr Column sampling_columns[] = {
    column<&SamplingRow::scene>("scene"),
    column<&SamplingRow::ordering>("ordering", Form::name, needed),
    column<&SamplingRow::parameters>("parameters"),
    column<&SamplingRow::cache_bytes>("cache_bytes", needed),
    column<&SamplingRow::line_bytes>("line_bytes", needed),
    column<&SamplingRow::ways>("ways", Form::ways, needed),
    column<&SamplingRow::set_sampling>("set_sampling", needed),
    column<&SamplingRow::seed>("seed"),
    column<&SamplingRow::misses>("misses", needed),
    column<&SamplingRow::misses_stderr>("misses_stderr"),
    column<&SamplingRow::misses_low>("misses_low"),
    column<&SamplingRow::misses_high>("misses_high"),
    column<&SamplingRow::exact_misses>("exact_misses", needed),
    column<&SamplingRow::covered>("covered"),
    column<&SamplingRow::seconds>("seconds", Form::seconds, needed),
    column<&SamplingRow::exact_seconds>("exact_seconds", Form::seconds),
};

}  // namespace

const RowKind& SamplingRow::kind() {
    static constexpr RowKind kind{"sampling", sampling_columns};
    return kind;
}

}  // namespace regather::results
