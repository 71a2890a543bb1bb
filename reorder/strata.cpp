#include "reorder/strata.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "reorder/curve.h"
#include "reorder/deferred.h"
#include "reorder/direction_binned.h"
#include "reorder/tiling.h"
#include "trace/error.h"

namespace regather::reorder {
namespace {

// In the frame of the world the first pass draws each direction (Philox 2x32-10, ten rounds of multiply, two
// exclusive-or, key add; a cosine-weighted direction; its turn into the world), finds its bin (cos theta:
// add, multiply, convert; phi: arc tangent, multiply, add, multiply, convert; multiply and add for the
// number) and puts it into the pixel's list by a counting sort (look up and add, then look up, add and look
// up).
constexpr std::uint64_t ops_per_listing = 10 * 4 + 7 + 15 + (3 + 5 + 2) + (2 + 3);
// Each pass looks at the head of each pixel's list: look up, compare, step on.
constexpr std::uint64_t ops_per_look = 3;

/// Of an entry in a pixel's list: which sample, and in which pass.
std::uint64_t entry_bytes(std::uint64_t samples, std::uint64_t passes) {
    return static_cast<std::uint64_t>(std::bit_width(samples - 1) + std::bit_width(passes - 1) + 7) / 8;
}

}  // namespace

Strata::Strata(const StrataConfig& config) : config_(config) {
    require_tile("strata", config.tile);
    trace::require_range("strata", "strata", config.strata, 1, max_strata);
    if (config.frame == StrataFrame::world && config.state == PixelState::recast)
        throw trace::UsageError(
            "strata: state is recast, expected store: in the frame of the world each pixel has a list to "
            "keep");
    const std::uint32_t n = config.strata;
    const auto place = [&](std::uint32_t stratum) -> std::uint64_t {
        const std::uint32_t row = stratum / n, column = stratum % n;
        switch (config.order) {
            case StrataOrder::columns:
                return std::uint64_t{column} * n + row;
            case StrataOrder::morton:
                return spread_bits(row) << 1 | spread_bits(column);
            default:
                return stratum;
        }
    };
    std::vector<std::uint32_t> made(n * n);
    std::iota(made.begin(), made.end(), 0u);
    std::sort(made.begin(), made.end(),
              [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
    rank_.resize(made.size());
    for (std::uint32_t pass = 0; pass < made.size(); ++pass) rank_[made[pass]] = pass;
}

Reads Strata::reads() const {
    const bool local = config_.frame == StrataFrame::local;
    return {.direction = !local, .stratum = local};
}

TilePasses Strata::tile_passes(const Workload& work) const {
    TilePasses passes{.tile = config_.tile, .passes = rank_.size(), .state = config_.state};
    if (config_.frame == StrataFrame::world) {
        const std::uint64_t samples =
            std::max<std::uint64_t>(queries_in_fullest_tile(work, Tiling(work, 1)), 1);
        passes.state_bytes += samples * entry_bytes(samples, rank_.size());
    }
    return passes;
}

void Strata::assign_passes(const Workload& work, std::span<std::uint64_t> pass) const {
    const Tiling tiling(work, config_.tile);
    const std::uint32_t n = config_.strata;
    const auto stratum_of = [&](std::size_t i) {
        if (config_.frame == StrataFrame::world) return direction_bin(work.direction[i], n);
        const std::uint32_t place = work.stratum[i];
        return ((place >> 16) * n >> 16) * n + ((place & 0xffff) * n >> 16);
    };
    tbb::parallel_for(std::size_t{0}, pass.size(), [&](std::size_t i) {
        pass[i] = std::uint64_t{tiling.tile_of(work.pixel[i])} * rank_.size() + rank_[stratum_of(i)];
    });
}

Cost Strata::assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                         std::span<std::uint64_t> keys) const {
    assign_passes(work, keys);
    Cost cost = cost_of(tile_passes(work), work, onchip_bytes);
    if (config_.frame == StrataFrame::world && rank_.size() > 1) {
        cost.keys = keys.size();
        cost.key_ops = cost.keys * ops_per_listing +
                       std::uint64_t{work.image_width} * work.image_height * rank_.size() * ops_per_look;
    }
    return cost;
}

BufferUse Strata::buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                             std::span<const std::uint32_t> permutation) const {
    std::vector<std::uint64_t> pass(permutation.size());
    assign_passes(work, pass);
    return buffer_use_of(tile_passes(work), work, onchip_bytes, permutation, pass);
}

}  // namespace regather::reorder
