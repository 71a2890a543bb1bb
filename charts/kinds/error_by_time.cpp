#include "charts/kinds.h"
#include "charts/over_time.h"

namespace regather::charts {

Chart error_by_time(const ChartKind& kind, const results::Rows& rows, const ChartOptions&) {
    return over_time(kind, rows,
                     {total_seconds, relative_rmse, "RMSE [% of mean]",
                      "seconds an image, with photon pass and tree", true, true});
}

}  // namespace regather::charts
