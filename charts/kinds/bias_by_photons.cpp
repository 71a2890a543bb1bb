#include "charts/bias.h"
#include "charts/kinds.h"

namespace regather::charts {

Chart bias_by_photons(const ChartKind& kind, const results::Rows& rows, const ChartOptions&) {
    return bias_chart(kind, rows, Varied::photons, "photons in the map");
}

}  // namespace regather::charts
