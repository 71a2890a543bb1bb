#include "replay/treelets.h"

#include "replay/layouts/placement.h"

namespace regather::replay {

Treelets::Treelets(const spatial::RayTree& tree, const Layout& layout, std::uint32_t bytes)
    : of_(tree.inner_nodes() + tree.leaves()) {
    const Placement pieces =
        clustered_order(tree, bytes, [&](std::uint32_t e) { return layout.extent(e).bytes; });
    std::size_t group = 0;
    for (std::size_t i = 0; i < pieces.elements.size(); ++i) {
        if (group < pieces.group_begins.size() && pieces.group_begins[group] == i) ++group;
        if (pieces.elements[i] >= of_.size()) break;  // places of the stack, which come last
        of_[pieces.elements[i]] = static_cast<std::uint32_t>(group - 1);
        count_ = static_cast<std::uint32_t>(group);
    }
}

}  // namespace regather::replay
