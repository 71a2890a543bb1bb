#include "charts/kinds.h"
#include "charts/sweep.h"

namespace regather::charts {

Chart cost_by_bins(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options) {
    const Sweep all = sweep(kind, rows.of<results::Row>(), Along::bins, options);
    if (!all.skipped.empty()) return skip(all.skipped);
    return draw_cost(kind, all);
}

}  // namespace regather::charts
