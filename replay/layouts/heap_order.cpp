#include "replay/layouts/placement.h"

namespace regather::replay {

Placement heap_order(const spatial::Structure& structure) {
    Placement placement;
    for (const spatial::ElementRange& range : structure.ranges())
        if (range.region != trace::Region::photon_power)
            for (std::uint32_t e = range.first; e < range.first + range.count; ++e)
                placement.elements.push_back(e);
    return placement;
}

}  // namespace regather::replay
