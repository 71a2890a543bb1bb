#include "cachesim/miss_class.h"

#include <cassert>

namespace regather::cachesim {

void MissClasses::count(std::uint32_t missing, std::uint32_t rank) {
    ++(missing == FullLru::first_touch ? compulsory : missing > rank ? capacity : conflict);
}

MissClasses& MissClasses::operator+=(const MissClasses& other) {
    compulsory += other.compulsory;
    capacity += other.capacity;
    conflict += other.conflict;
    return *this;
}

FullLru::FullLru(std::span<const std::uint64_t> capacities)
    : capacities_(capacities.begin(), capacities.end()), last_(capacities.size(), no_entry) {}

std::uint32_t FullLru::access(std::uint32_t id) {
    if (id == order_.newest) return 0;
    const bool first = id >= nodes_.size();
    assert(!first || id == nodes_.size());
    std::uint32_t missing = 0;
    if (first) {
        nodes_.push_back({});
        while (missing < last_.size() && last_[missing] != no_entry) ++missing;
    } else {
        missing = nodes_[id].missing;
        // Only the smallest cache that holds it can have it at its end.
        if (missing < last_.size() && last_[missing] == id) last_[missing] = nodes_[id].newer;
        order_.leave(nodes_, id);
        nodes_[id].missing = 0;
    }
    order_.enter(nodes_, id);
    push_down(missing);
    if (!first) return missing;
    if (missing < last_.size() && nodes_.size() == capacities_[missing]) last_[missing] = order_.oldest;
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
