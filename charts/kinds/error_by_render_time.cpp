#include "charts/kinds.h"
#include "charts/over_time.h"

namespace regather::charts {

Chart error_by_render_time(const ChartKind& kind, const results::Rows& rows, const ChartOptions&) {
    const OverTime::Value render_seconds = [](const results::ConvergenceRow& row) {
        return std::optional<double>(row.render_seconds);
    };
    return over_time(kind, rows,
                     {render_seconds, relative_rmse, "RMSE [% of mean]",
                      "seconds an image, queries and gathers alone", true, true});
}

}  // namespace regather::charts
