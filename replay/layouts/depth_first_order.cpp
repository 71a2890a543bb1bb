#include <algorithm>

#include "replay/layouts/placement.h"

namespace regather::replay {

Placement depth_first_order(const spatial::Structure& structure) {
    Placement placement;
    std::vector<std::uint32_t> waiting = structure.roots(), children;
    std::reverse(waiting.begin(), waiting.end());
    while (!waiting.empty()) {
        const std::uint32_t element = waiting.back();
        waiting.pop_back();
        placement.elements.push_back(element);
        children.clear();
        structure.append_children(element, children);
        waiting.insert(waiting.end(), children.rbegin(), children.rend());
    }
    return placement;
}

}  // namespace regather::replay
