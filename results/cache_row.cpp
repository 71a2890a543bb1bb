#include "results/cache_row.h"

namespace regather::results {
namespace {

constexpr Column cache_columns[] = {
    column<&CacheRow::policy>("policy", needed),
    column<&CacheRow::size_bytes>("size_bytes", needed),
    column<&CacheRow::line_bytes>("line_bytes", needed),
    column<&CacheRow::ways>("ways", Form::ways, needed),
    column<&CacheRow::accesses>("accesses"),
    column<&CacheRow::hits>("hits"),
    column<&CacheRow::misses>("misses", needed),
    column<&CacheRow::compulsory>("compulsory"),
    column<&CacheRow::capacity>("capacity"),
    column<&CacheRow::conflict>("conflict"),
    column<&CacheRow::writebacks>("writebacks"),
    column<&CacheRow::writes_through>("writes_through"),
    column<&CacheRow::traffic_bytes>("traffic_bytes"),
    column<&CacheRow::write>("write"),
    column<&CacheRow::write_miss>("write_miss"),
    column<&CacheRow::index>("index"),
    column<&CacheRow::seed>("seed"),
};

}  // namespace

const RowKind& CacheRow::kind() {
    static constexpr RowKind kind{"cache", cache_columns};
    return kind;
}

}  // namespace regather::results
