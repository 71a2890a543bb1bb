#include "trace/packed_photon.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace regather::trace {
namespace {

constexpr int axis_bits = 21;

}  // namespace

Packing::Packing(std::span<const Photon> photons) {
    if (photons.empty()) return;
    low_ = high_ = photons.front().position;
    for (const Photon& photon : photons)
        for (int axis = 0; axis < 3; ++axis) {
            low_[axis] = std::min(low_[axis], photon.position[axis]);
            high_[axis] = std::max(high_[axis], photon.position[axis]);
        }
    for (int axis = 0; axis < 3; ++axis)
        step_[static_cast<std::size_t>(axis)] =
            (static_cast<double>(high_[axis]) - static_cast<double>(low_[axis])) / steps;
}

PackedPhoton Packing::pack(const Photon& photon) const {
    PackedPhoton packed{.theta = photon.theta, .phi = photon.phi, .flags = photon.flags};
    std::memcpy(packed.power, photon.power, sizeof packed.power);
    for (int axis = 0; axis < 3; ++axis) {
        if (!(step(axis) > 0)) continue;
        const double at =
            (static_cast<double>(photon.position[axis]) - static_cast<double>(low_[axis])) / step(axis);
        const auto nearest = static_cast<std::uint64_t>(std::clamp(std::floor(at + 0.5), 0.0, double{steps}));
        packed.position |= nearest << (axis_bits * axis);
    }
    return packed;
}

Photon Packing::unpack(const PackedPhoton& packed) const {
    Photon photon{.position = low_, .theta = packed.theta, .phi = packed.phi, .flags = packed.flags};
    std::memcpy(photon.power, packed.power, sizeof photon.power);
    for (int axis = 0; axis < 3; ++axis) {
        const std::uint64_t at = packed.position >> (axis_bits * axis) & steps;
        photon.position[axis] =
            at == steps
                ? high_[axis]
                : static_cast<float>(static_cast<double>(low_[axis]) + static_cast<double>(at) * step(axis));
    }
    return photon;
}

double pack_positions(std::span<Photon> photons) {
    const Packing packing(photons);
    double farthest = 0;
    for (Photon& photon : photons) {
        const Photon before = photon;
        photon = packing.unpack(packing.pack(before));
        farthest = std::max(farthest, length(Vec3d(photon.position) - Vec3d(before.position)));
    }
    return farthest;
}

}  // namespace regather::trace
