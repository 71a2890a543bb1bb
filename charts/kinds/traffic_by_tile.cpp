#include "charts/kinds.h"
#include "charts/sweep.h"

namespace regather::charts {

Chart traffic_by_tile(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options) {
    const Sweep all = sweep(kind, rows.of<results::Row>(), Along::tile, options);
    if (!all.skipped.empty()) return skip(all.skipped);
    std::string cache = results::geometry_text(all.cache);
    return draw_traffic(kind, all, cache.insert(cache.find(','), " cache"));
}

}  // namespace regather::charts
