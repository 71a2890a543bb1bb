#include "cachesim/miss_class.h"

#include <cassert>

namespace regather::cachesim {

FullLru::FullLru(std::span<const std::uint64_t> capacities)
    : capacities_(capacities.begin(), capacities.end()), last_(capacities.size(), none) {}

std::uint32_t FullLru::access(std::uint32_t id) {
    if (id == newest_) return 0;
    const bool first = id >= nodes_.size();
    assert(!first || id == nodes_.size());
    std::uint32_t missing = 0;
    if (first) {
        nodes_.push_back({});
        while (missing < last_.size() && last_[missing] != none) ++missing;
    } else {
        const Node node = nodes_[id];
        missing = node.missing;
        // Only the smallest cache that holds it can have it at its end.
        if (missing < last_.size() && last_[missing] == id) last_[missing] = node.newer;
        nodes_[node.newer].older = node.older;
        (node.older == none ? oldest_ : nodes_[node.older].newer) = node.newer;
    }
    nodes_[id] = {none, newest_, 0};
    (newest_ == none ? oldest_ : nodes_[newest_].newer) = id;
    newest_ = id;
    push_down(missing);
    if (!first) return missing;
    if (missing < last_.size() && nodes_.size() == capacities_[missing]) last_[missing] = oldest_;
    return first_touch;
}

/// The smallest `caches`, which are full, lose the line at their end.
void FullLru::push_down(std::uint32_t caches) {
    for (std::uint32_t cache = 0; cache < caches; ++cache) {
        Node& lost = nodes_[last_[cache]];
        lost.missing = cache + 1;
        last_[cache] = lost.newer;
    }
}

}  // namespace regather::cachesim
