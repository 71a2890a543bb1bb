// trace/photon.h -- the 20-byte photon of Jensen, "Realistic Image Synthesis Using Photon Mapping", 2001,
// section 5.1.2: position, power as shared-exponent RGBE (Ward, "Real Pixels", Graphics Gems II), incident
// direction as two spherical angles of a byte each, and flags. This is the byte layout that the simulated
// memory holds.
#pragma once
#include <cstdint>
#include <type_traits>

#include "trace/vec.h"

namespace regather::trace {

struct Photon {
    Vec3 position;            ///< [scene units]
    std::uint8_t power[4]{};  ///< RGBE, [W] of this photon.
    std::uint8_t theta = 0;   ///< Of the direction the photon travels in: [0, 255] for [0, pi].
    std::uint8_t phi = 0;     ///< [0, 255] for [-pi, pi].
    std::uint16_t flags = 0;  ///< Bits 0-1: split axis of the kd-tree node that the photon is (0 x, 1 y, 2
                              ///< z). Bits 2-15: normal of the surface that stores it, 0: not told.
};
static_assert(sizeof(Photon) == 20 && std::is_trivially_copyable_v<Photon> &&
              std::is_standard_layout_v<Photon>);

/// RGBE of a finite, non-negative triple, truncated; decoded to the middle of the interval, so each channel
/// is within 1/256 of the largest channel; a channel under 1/128 of the largest may be lost, and so is a
/// triple under 2^-128 [W].
void encode_power(Vec3 power, std::uint8_t rgbe[4]);
Vec3 decode_power(const std::uint8_t rgbe[4]);

/// `direction` has unit length; decode_direction(encode) is within 0.02 rad of it.
void encode_direction(Vec3 direction, Photon& photon);
Vec3 decode_direction(const Photon& photon);  ///< Unit length; by table, 256 x 256.

/// The side of the surface that the photon lies on: octahedral coordinates (Meyer et al., "On Floating-Point
/// Normal Vectors", EGSR 2010) of seven bits each, exact along the axes, within 0.034 rad elsewhere. `normal`
/// has unit length.
void encode_normal(Vec3 normal, Photon& photon);
Vec3 decode_normal(
    const Photon& photon);  ///< Unit length; zero when the photon does not tell. By table, 128 x 128.

}  // namespace regather::trace
