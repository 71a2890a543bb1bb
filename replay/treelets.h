// replay/treelets.h -- a hierarchy cut into treelets, connected pieces of bounded bytes: what a cache is to
// hold while many rays run through it.
#pragma once
#include <cstdint>
#include <vector>

#include "replay/layout.h"
#include "spatial/rays/ray_tree.h"

namespace regather::replay {

class Treelets {
public:
    /// The pieces of clustered_order(): from a root on, level by level, as many nodes and leaves as `bytes`
    /// hold, each with what a visit reads; what hangs below them begins pieces of its own. An element that is
    /// larger is a piece of its own.
    Treelets(const spatial::RayTree& tree, const Layout& layout, std::uint32_t bytes);

    /// Of a node or leaf: the treelet's number; that of the root is 0.
    std::uint32_t of(std::uint32_t element) const { return of_[element]; }
    std::uint32_t count() const { return count_; }

private:
    std::vector<std::uint32_t> of_;
    std::uint32_t count_ = 0;
};

}  // namespace regather::replay
