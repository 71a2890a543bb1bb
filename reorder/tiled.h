// reorder/tiled.h -- the image in square tiles, each in row order. The paper, section 6.3.1, "Tiled
// reordering": no additional storage, and the extra computation is negligible.
#pragma once
#include "reorder/ordering.h"

namespace regather::reorder {

enum class Rows : std::uint8_t { left_to_right, alternating };

struct TiledConfig {
    std::uint32_t tile = 16;          ///< Edge [pixels].
    Rows rows = Rows::left_to_right;  ///< alternating: every second row of a tile runs right to left.
};

/// The samples of a pixel stay together, in capture order.
class Tiled final : public Ordering {
public:
    explicit Tiled(const TiledConfig& config);  ///< trace::UsageError names the field at fault.
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<std::uint64_t> keys) const override;
    BufferUse buffer_use(const Workload&, std::uint64_t, std::span<const std::uint32_t>) const override {
        return {};
    }

private:
    TiledConfig config_;
};

}  // namespace regather::reorder
