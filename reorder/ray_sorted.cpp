#include "reorder/ray_sorted.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "reorder/cell.h"
#include "reorder/deferred.h"
#include "reorder/tiling.h"

namespace regather::reorder {
namespace {

constexpr std::uint32_t most_coordinates = 6;
// Of the direction: three magnitudes and their sum (5), two divisions, the fold of the lower half (two
// comparisons, four subtractions and signs), and two cells of subtract, multiply, clamp twice, convert (10).
constexpr std::uint64_t octahedron_ops = 23;

/// A point of [0, 1] x [0, 1] for a direction: the sphere on an octahedron, its lower half folded outwards.
std::array<float, 2> on_octahedron(Vec3 d) {
    const float sum = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z);
    float u = d.x / sum, v = d.y / sum;
    if (d.z < 0) {
        const float folded = (1 - std::fabs(v)) * (u < 0 ? -1.0f : 1.0f);
        v = (1 - std::fabs(u)) * (v < 0 ? -1.0f : 1.0f);
        u = folded;
    }
    return {(u + 1) * 0.5f, (v + 1) * 0.5f};
}

/// Bits of the coordinates in turn, the highest first.
std::uint64_t interleaved(std::span<const std::uint32_t> coordinates, std::uint32_t bits) {
    std::uint64_t code = 0;
    for (std::uint32_t bit = bits; bit-- > 0;)
        for (const std::uint32_t c : coordinates) code = code << 1 | (c >> bit & 1);
    return code;
}

}  // namespace

RaySorted::RaySorted(const RaySortedConfig& config) : config_(config) {
    const auto check = [&config](std::string_view name, std::uint32_t most) {
        require_tile(name, config.tile);
        trace::require_range(name, "bits", config.bits, 1, most);
    };
    switch (config.key) {
        case RayKey::origin_direction:
            check("origin-direction", 12);
            break;
        case RayKey::origin_end:
            check("origin-end", 10);
            break;
        case RayKey::origin_guess:
            check("origin-guess", 10);
            break;
    }
}

Reads RaySorted::reads() const {
    Reads reads;
    reads.direction = config_.key == RayKey::origin_direction;
    reads.end = config_.key == RayKey::origin_end;
    reads.guess = config_.key == RayKey::origin_guess;
    return reads;
}

Cost RaySorted::assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                            std::span<std::uint64_t> keys) const {
    const bool ends = config_.key != RayKey::origin_direction;
    const std::span<const Vec3> end = config_.key == RayKey::origin_guess ? work.guess : work.end;
    Bounds3 bounds = work.bounds;
    if (ends) bounds.include(trace::bounds_of(end));
    const std::uint32_t coordinates = ends ? 6 : 5;
    const Tiling tiling(work, config_.tile);
    const auto tile_bits = static_cast<std::uint32_t>(std::bit_width(tiling.tiles() - 1));
    const std::uint32_t bits = std::min(config_.bits, (63 - tile_bits) / coordinates);
    const CellGrid grid(bounds, 1u << bits);
    Bounds3 unit;
    unit.include(Vec3{0, 0, 0});
    unit.include(Vec3{1, 1, 1});
    const CellGrid square(unit, 1u << bits);
    const std::uint64_t beyond = std::uint64_t{1} << coordinates * bits;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, keys.size(), 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const std::uint64_t tile = std::uint64_t{tiling.tile_of(work.pixel[i])} << coordinates * bits
                                                                                    << 1;
            const Vec3 second = ends ? end[i] : work.direction[i];
            if (!is_finite(work.position[i]) || !is_finite(second) || (!ends && second == Vec3{})) {
                keys[i] = tile | beyond;
                continue;
            }
            std::array<std::uint32_t, most_coordinates> c{};
            const Cell origin = grid.cell_of(work.position[i]);
            std::copy(origin.begin(), origin.end(), c.begin());
            if (ends) {
                const Cell other = grid.cell_of(second);
                std::copy(other.begin(), other.end(), c.begin() + 3);
            } else {
                const auto [u, v] = on_octahedron(second);
                c[3] = square.along(u, 0);
                c[4] = square.along(v, 1);
            }
            keys[i] = tile | interleaved(std::span(c).first(coordinates), bits);
        }
    });
    // A shift, an and, a shift and an or for each bit.
    const std::uint64_t ops =
        CellGrid::ops + (ends ? CellGrid::ops : octahedron_ops) + std::uint64_t{4} * coordinates * bits;
    Cost cost =
        deferred_cost(work, tiling, {.ops_per_key = ops, .key_bits = coordinates * bits}, onchip_bytes);
    if (config_.key == RayKey::origin_guess) cost.recast_rays = cost.keys;
    return cost;
}

BufferUse RaySorted::buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                                std::span<const std::uint32_t> permutation) const {
    return deferred_buffer_use(work, Tiling(work, config_.tile), onchip_bytes, permutation);
}

}  // namespace regather::reorder
