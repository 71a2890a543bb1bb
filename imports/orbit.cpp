#include "imports/orbit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace regather::imports {

std::vector<KeyFrame> keys_of(const Orbit& orbit) {
    const std::uint32_t last = orbit.frames - 1;
    const double sweep = orbit.to_degrees - orbit.from_degrees;
    const auto steps = std::clamp(static_cast<std::uint32_t>(std::ceil(std::abs(sweep) / 10)), 1u, last);
    std::vector<KeyFrame> keys;
    for (std::uint32_t i = 0; i <= steps; ++i) {
        KeyFrame key;
        key.frame = static_cast<std::uint32_t>(std::uint64_t{last} * i / steps);
        const double angle = (orbit.from_degrees + sweep * key.frame / last) * std::numbers::pi / 180;
        key.position = orbit.center + Vec3{static_cast<float>(orbit.distance * std::cos(angle)),
                                           static_cast<float>(orbit.distance * std::sin(angle)),
                                           static_cast<float>(orbit.height)};
        key.target = orbit.center;
        keys.push_back(key);
    }
    return keys;
}

}  // namespace regather::imports
