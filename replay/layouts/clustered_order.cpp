#include <algorithm>

#include "replay/layouts/placement.h"

namespace regather::replay {

Placement clustered_order(const spatial::Structure& structure, std::uint32_t line_bytes,
                          const std::function<std::uint32_t(std::uint32_t)>& bytes) {
    Placement placement;
    std::vector<std::uint32_t> roots = structure.roots(), group;
    std::reverse(roots.begin(), roots.end());
    while (!roots.empty()) {
        group.assign(1, roots.back());
        roots.pop_back();
        placement.group_begins.push_back(static_cast<std::uint32_t>(placement.elements.size()));
        // group[0 .. taken) is in the group, the rest waits: first come, first served.
        std::size_t taken = 0;
        std::uint64_t held = 0;
        while (taken < group.size() && (taken == 0 || held + bytes(group[taken]) <= line_bytes)) {
            held += bytes(group[taken]);
            structure.append_children(group[taken++], group);
        }
        placement.elements.insert(placement.elements.end(), group.begin(),
                                  group.begin() + static_cast<std::ptrdiff_t>(taken));
        roots.insert(roots.end(), group.rbegin(), group.rend() - static_cast<std::ptrdiff_t>(taken));
    }
    return placement;
}

}  // namespace regather::replay
