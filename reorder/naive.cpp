#include "reorder/naive.h"

#include <algorithm>

namespace regather::reorder {

Cost Naive::assign_keys(const Workload&, std::uint64_t, std::span<std::uint64_t> keys) const {
    std::fill(keys.begin(), keys.end(), 0);
    return {};
}

}  // namespace regather::reorder
