#include "trace/photon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace regather::trace {

void encode_power(Vec3 power, std::uint8_t rgbe[4]) {
    const float largest = max_component(power);
    int exponent = 0;
    std::frexp(largest, &exponent);  // largest = m 2^exponent, m in [0.5, 1)
    if (!(largest > 0) || exponent < -127) {
        std::fill_n(rgbe, 4, std::uint8_t{0});
        return;
    }
    exponent = std::min(exponent, 127);
    const float scale = std::ldexp(1.0f, 8 - exponent);
    for (int c = 0; c < 3; ++c)
        rgbe[c] = static_cast<std::uint8_t>(std::clamp(power[c] * scale, 0.0f, 255.0f));
    rgbe[3] = static_cast<std::uint8_t>(exponent + 128);
}

Vec3 decode_power(const std::uint8_t rgbe[4]) {
    if (rgbe[3] == 0) return {};
    static const std::array<float, 256> scale = [] {
        std::array<float, 256> table{};
        for (int e = 0; e < 256; ++e) table[static_cast<std::size_t>(e)] = std::ldexp(1.0f, e - 128 - 8);
        return table;
    }();
    // The middle of the truncated interval: no bias over many photons.
    const float f = scale[rgbe[3]];
    const auto channel = [f](std::uint8_t v) { return v == 0 ? 0.0f : (static_cast<float>(v) + 0.5f) * f; };
    return {channel(rgbe[0]), channel(rgbe[1]), channel(rgbe[2])};
}

void encode_direction(Vec3 direction, Photon& photon) {
    const double theta = std::acos(std::clamp(static_cast<double>(direction.z), -1.0, 1.0));
    const double phi = std::atan2(static_cast<double>(direction.y), static_cast<double>(direction.x));
    photon.theta = static_cast<std::uint8_t>(std::min(255.0, theta * (256.0 / std::numbers::pi)));
    photon.phi =
        static_cast<std::uint8_t>(std::min(255.0, (phi + std::numbers::pi) * (128.0 / std::numbers::pi)));
}

Vec3 decode_direction(const Photon& photon) {
    struct Circle {
        std::array<float, 256> cos_theta, sin_theta, cos_phi, sin_phi;
    };
    static const Circle table = [] {
        Circle t{};
        for (std::size_t i = 0; i < 256; ++i) {
            const double theta = (static_cast<double>(i) + 0.5) * (std::numbers::pi / 256);
            const double phi = (static_cast<double>(i) + 0.5) * (std::numbers::pi / 128) - std::numbers::pi;
            t.cos_theta[i] = static_cast<float>(std::cos(theta));
            t.sin_theta[i] = static_cast<float>(std::sin(theta));
            t.cos_phi[i] = static_cast<float>(std::cos(phi));
            t.sin_phi[i] = static_cast<float>(std::sin(phi));
        }
        return t;
    }();
    return {table.sin_theta[photon.theta] * table.cos_phi[photon.phi],
            table.sin_theta[photon.theta] * table.sin_phi[photon.phi], table.cos_theta[photon.theta]};
}

namespace {

constexpr int octahedral_steps = 63;  // On either side of zero: 127 values of a coordinate, and 0 for none

std::uint16_t octahedral(float coordinate) {
    return static_cast<std::uint16_t>(octahedral_steps + 1 +
                                      std::lround(std::clamp(coordinate, -1.0f, 1.0f) * octahedral_steps));
}

}  // namespace

void encode_normal(Vec3 n, Photon& photon) {
    const float sum = std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z);
    float u = n.x / sum, v = n.y / sum;
    if (n.z < 0) {
        const float folded = (1 - std::fabs(v)) * std::copysign(1.0f, u);
        v = (1 - std::fabs(u)) * std::copysign(1.0f, v);
        u = folded;
    }
    photon.flags = static_cast<std::uint16_t>((photon.flags & 3u) | octahedral(u) << 2 | octahedral(v) << 9);
}

Vec3 decode_normal(const Photon& photon) {
    static const std::vector<Vec3> table = [] {
        std::vector<Vec3> normals(128 * 128);
        for (int v = 1; v < 128; ++v)
            for (int u = 1; u < 128; ++u) {
                double x = static_cast<double>(u - octahedral_steps - 1) / octahedral_steps;
                double y = static_cast<double>(v - octahedral_steps - 1) / octahedral_steps;
                const double z = 1 - std::fabs(x) - std::fabs(y);
                if (z < 0) {
                    const double folded = (1 - std::fabs(y)) * std::copysign(1.0, x);
                    y = (1 - std::fabs(x)) * std::copysign(1.0, y);
                    x = folded;
                }
                const double size = std::sqrt(x * x + y * y + z * z);
                normals[static_cast<std::size_t>(v) * 128 + static_cast<std::size_t>(u)] = {
                    static_cast<float>(x / size), static_cast<float>(y / size), static_cast<float>(z / size)};
            }
        return normals;
    }();
    return table[photon.flags >> 2];
}

}  // namespace regather::trace
