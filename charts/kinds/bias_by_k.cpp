#include "charts/bias.h"
#include "charts/kinds.h"

namespace regather::charts {

Chart bias_by_k(const ChartKind& kind, const results::Rows& rows, const ChartOptions&) {
    return bias_chart(kind, rows, Varied::k, "photons of a gather (k)");
}

}  // namespace regather::charts
