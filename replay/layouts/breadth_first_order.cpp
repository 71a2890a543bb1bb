#include "replay/layouts/placement.h"

namespace regather::replay {

Placement breadth_first_order(const spatial::Structure& structure) {
    Placement placement;
    placement.elements = structure.roots();
    for (std::size_t i = 0; i < placement.elements.size(); ++i)
        structure.append_children(placement.elements[i], placement.elements);
    return placement;
}

}  // namespace regather::replay
