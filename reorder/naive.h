// reorder/naive.h -- capture order: pixels in row order, the samples of a pixel together. The paper,
// section 6.3.1, "Naive ordering": no additional storage or computation.
#pragma once
#include "reorder/ordering.h"

namespace regather::reorder {

class Naive final : public Ordering {
public:
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<std::uint64_t> keys) const override;
    BufferUse buffer_use(const Workload&, std::uint64_t, std::span<const std::uint32_t>) const override {
        return {};
    }
};

}  // namespace regather::reorder
