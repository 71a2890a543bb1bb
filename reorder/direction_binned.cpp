#include "reorder/direction_binned.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

#include "reorder/tiling.h"

namespace regather::reorder {
namespace {

// A pass draws each direction of each of its pixels again and tests it: two random numbers by Philox 2x32-10
// (ten rounds of multiply, two exclusive-or, key add), a cosine-weighted direction (two square roots,
// subtract, sine, cosine, two multiplies), its turn into the world (nine multiplies, six adds), and the
// interval (z against two limits, two half-planes of two multiplies, subtract and compare each, three ands).
constexpr std::uint64_t ops_per_test = 10 * 4 + 7 + 15 + (2 + 8 + 3);

std::uint32_t bin_along(double fraction, std::uint32_t bins) {
    return static_cast<std::uint32_t>(std::clamp(std::floor(fraction * bins), 0.0, bins - 1.0));
}

}  // namespace

std::uint32_t direction_bin(Vec3 direction, std::uint32_t bins) {
    // The sum turns -0 into 0: a pole has one phi.
    const double x = direction.x + 0.0, y = direction.y + 0.0, z = direction.z;
    const double length = std::sqrt(x * x + y * y + z * z);
    if (!(length > 0) || std::isinf(length)) return bins * bins - 1;
    double turn = std::atan2(y, x) / (2 * std::numbers::pi);
    if (turn < 0) turn += 1;
    return bin_along((z / length + 1) / 2, bins) * bins + bin_along(turn, bins);
}

DirectionBinned::DirectionBinned(const DirectionBinnedConfig& config) : config_(config) {
    require_tile("direction-binned", config.tile);
    trace::require_range("direction-binned", "bins", config.bins, 1, max_bins);
    if (config_.passes == 0) config_.passes = config_.bins * config_.bins;
    trace::require_range("direction-binned", "passes", config_.passes, 1,
                         std::uint64_t{config_.bins} * config_.bins);
}

TilePasses DirectionBinned::tile_passes() const {
    return {.tile = config_.tile, .passes = config_.passes, .state = config_.state};
}

void DirectionBinned::assign_passes(const Workload& work, std::span<std::uint64_t> pass) const {
    const Tiling tiling(work, config_.tile);
    const std::uint64_t bins = std::uint64_t{config_.bins} * config_.bins, passes = config_.passes;
    tbb::parallel_for(std::size_t{0}, pass.size(), [&](std::size_t i) {
        pass[i] = tiling.tile_of(work.pixel[i]) * passes +
                  direction_bin(work.direction[i], config_.bins) * passes / bins;
    });
}

Cost DirectionBinned::assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                                  std::span<std::uint64_t> keys) const {
    assign_passes(work, keys);
    Cost cost = cost_of(tile_passes(), work, onchip_bytes);
    cost.keys = keys.size() * config_.passes;
    cost.key_ops = cost.keys * ops_per_test;
    return cost;
}

BufferUse DirectionBinned::buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                                      std::span<const std::uint32_t> permutation) const {
    std::vector<std::uint64_t> pass(permutation.size());
    assign_passes(work, pass);
    return buffer_use_of(tile_passes(), work, onchip_bytes, permutation, pass);
}

}  // namespace regather::reorder
