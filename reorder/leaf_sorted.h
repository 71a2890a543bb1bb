// reorder/leaf_sorted.h -- queries sorted by the leaf of the ray-casting structure that their ray ended in.
// The paper, section 6.3.2, "Other interesting reorderings": leaves are labelled depth-first; the label comes
// with the ray.
#pragma once
#include <optional>

#include "reorder/ordering.h"

namespace regather::reorder {

enum class LeafColumn : std::uint8_t { kd, bvh };

struct LeafSortedConfig {
    LeafColumn column = LeafColumn::kd;
    std::optional<std::uint32_t> tile;  ///< Edge [pixels]; none: the whole image at once.
};

class LeafSorted final : public Ordering {
public:
    explicit LeafSorted(const LeafSortedConfig& config);  ///< trace::UsageError names the field at fault.
    Reads reads() const override;
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<std::uint64_t> keys) const override;
    BufferUse buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                         std::span<const std::uint32_t> permutation) const override;

private:
    LeafSortedConfig config_;
};

}  // namespace regather::reorder
