#include "charts/kinds.h"
#include "charts/over_time.h"

namespace regather::charts {

Chart efficiency(const ChartKind& kind, const results::Rows& rows, const ChartOptions&) {
    const OverTime::Value relative = [](const results::ConvergenceRow& row) -> std::optional<double> {
        if (!row.efficiency || row.mean_radiance.value_or(0) <= 0) return {};
        return *row.efficiency * *row.mean_radiance * *row.mean_radiance;
    };
    return over_time(kind, rows,
                     {total_seconds, relative, "mean² / (variance × s)",
                      "seconds an image, with photon pass and tree", false, false});
}

}  // namespace regather::charts
