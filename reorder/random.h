// reorder/random.h -- a random order: the worst case, a yardstick that claims no cost.
// Keys are Philox 4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011) of the
// query number.
#pragma once
#include "reorder/ordering.h"

namespace regather::reorder {

class Random final : public Ordering {
public:
    explicit Random(std::uint64_t seed) : seed_(seed) {}
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<std::uint64_t> keys) const override;
    BufferUse buffer_use(const Workload&, std::uint64_t, std::span<const std::uint32_t>) const override {
        return {};
    }

private:
    std::uint64_t seed_;
};

}  // namespace regather::reorder
