#include "charts/kinds.h"
#include "charts/sweep.h"

namespace regather::charts {

Chart traffic_by_cache(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options) {
    const Sweep all = sweep(kind, rows.of<results::Row>(), Along::cache, options);
    if (!all.skipped.empty()) return skip(all.skipped);
    const std::string cache = results::geometry_text(all.cache);
    return draw_traffic(kind, all, cache.substr(cache.find(',') + 2));
}

}  // namespace regather::charts
