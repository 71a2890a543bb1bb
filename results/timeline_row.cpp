#include "results/timeline_row.h"

namespace regather::results {
namespace {

constexpr Column timeline_columns[] = {
    column<&TimelineRow::scene>("scene"),
    column<&TimelineRow::ordering>("ordering", Form::name, needed),
    column<&TimelineRow::tile>("tile"),
    column<&TimelineRow::bins>("bins"),
    column<&TimelineRow::parameters>("parameters"),
    column<&TimelineRow::cache_bytes>("cache_bytes", needed),
    column<&TimelineRow::line_bytes>("line_bytes", needed),
    column<&TimelineRow::ways>("ways", Form::ways, needed),
    column<&TimelineRow::slice>("slice", needed),
    column<&TimelineRow::first_query>("first_query", needed),
    column<&TimelineRow::queries>("queries", needed),
    column<&TimelineRow::accesses>("accesses"),
    column<&TimelineRow::misses>("misses", needed),
};

}  // namespace

const RowKind& TimelineRow::kind() {
    static constexpr RowKind kind{"timeline", timeline_columns};
    return kind;
}

}  // namespace regather::results
