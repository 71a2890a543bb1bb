// replay/layout.h -- where a node lies in memory: a choice of the replay, not of the capture. Addresses are
// computed, never taken from the host.
#pragma once
#include <cstdint>
#include <string_view>

namespace regather::replay {

/// Nodes in heap order, `stride_bytes` apart, of which a visit reads `used_bytes`. The paper's photon: 20
/// of 20.
struct HeapLayout {
    std::string_view name = "heap-20";
    std::uint64_t base = 0;  ///< Address of the first node.
    std::uint32_t stride_bytes = 20, used_bytes = 20;

    /// `slot` counts from 1, as in the heap.
    std::uint64_t address(std::uint32_t slot) const { return base + std::uint64_t{slot - 1} * stride_bytes; }
};

}  // namespace regather::replay
