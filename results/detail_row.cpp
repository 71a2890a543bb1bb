#include "results/detail_row.h"

namespace regather::results {
namespace {

constexpr Column detail_columns[] = {
    column<&DetailRow::scene>("scene"),
    column<&DetailRow::ordering>("ordering", Form::name, needed),
    column<&DetailRow::tile>("tile"),
    column<&DetailRow::bins>("bins"),
    column<&DetailRow::parameters>("parameters"),
    column<&DetailRow::layout>("layout"),
    column<&DetailRow::policy>("policy"),
    column<&DetailRow::cache_bytes>("cache_bytes", needed),
    column<&DetailRow::line_bytes>("line_bytes", needed),
    column<&DetailRow::ways>("ways", Form::ways, needed),
    column<&DetailRow::region>("region", needed),
    column<&DetailRow::tree_depth>("tree_depth", needed),
    column<&DetailRow::accesses>("accesses"),
    column<&DetailRow::misses>("misses", needed),
    column<&DetailRow::compulsory>("compulsory"),
    column<&DetailRow::capacity>("capacity"),
    column<&DetailRow::conflict>("conflict"),
    column<&DetailRow::traffic_bytes>("traffic_bytes"),
    column<&DetailRow::used_bytes>("used_bytes"),
};

}  // namespace

const RowKind& DetailRow::kind() {
    static constexpr RowKind kind{"detail", detail_columns};
    return kind;
}

}  // namespace regather::results
