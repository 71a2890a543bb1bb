// trace/packed_photon.h -- the photon of trace/photon.h in 16 bytes: its position in 21 bits an axis through
// the box of all photons, power, direction, split axis and normal as they are.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

#include "trace/photon.h"

namespace regather::trace {

struct PackedPhoton {
    std::uint64_t position = 0;  ///< Bits 0-20 x, 21-41 y, 42-62 z: steps from the lowest corner of the box.
    std::uint8_t power[4]{};
    std::uint8_t theta = 0, phi = 0;
    std::uint16_t flags = 0;
};
static_assert(sizeof(PackedPhoton) == 16 && std::is_trivially_copyable_v<PackedPhoton> &&
              std::is_standard_layout_v<PackedPhoton>);

/// How the positions of some photons are packed. The box, six numbers, belongs to all of them.
class Packing {
public:
    static constexpr std::uint32_t steps =
        (1u << 21) - 1;  ///< Along each axis, from face to face of the box.

    /// Of photons with finite positions.
    explicit Packing(std::span<const Photon> photons);

    /// Of a photon in the box; each axis goes to its nearest step.
    PackedPhoton pack(const Photon& photon) const;
    /// What differs from the photon that was packed is its position, along an axis by half a step() at most
    /// and the rounding to a float. Faces of the box come back as they were; what came back packs to itself.
    Photon unpack(const PackedPhoton& packed) const;
    /// [scene units]
    double step(int axis) const { return step_[static_cast<std::size_t>(axis)]; }

private:
    Vec3 low_, high_;
    std::array<double, 3> step_{};
};

/// Packs each of the photons and takes what comes back. Returns how far one moved at most [scene units].
double pack_positions(std::span<Photon> photons);

}  // namespace regather::trace
