#include "imports/texture_colour.h"

#include <array>
#include <cmath>

#include "imports/texture.h"

namespace regather::imports {

namespace {

std::array<double, 256> srgb_decoded() {
    std::array<double, 256> table;
    for (int i = 0; i < 256; ++i) {
        const double s = i / 255.0;
        table[static_cast<std::size_t>(i)] = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    }
    return table;
}

}  // namespace

trace::Vec3 mean_colour(std::span<const std::uint8_t> bytes, const std::string& name) {
    static const std::array<double, 256> decoded = srgb_decoded();
    const Texture texture = read_texture(bytes, name);
    std::array<double, 3> sum{}, opaque_sum{};
    double weight = 0;
    for (const auto& texel : texture.texels) {
        const double alpha = texel[3] / 255.0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = decoded[texel[c]];
            sum[c] += alpha * value;
            opaque_sum[c] += value;
        }
        weight += alpha;
    }
    if (weight <= 0)  // An alpha channel that hides all.
        sum = opaque_sum, weight = static_cast<double>(texture.texels.size());
    return {static_cast<float>(sum[0] / weight), static_cast<float>(sum[1] / weight),
            static_cast<float>(sum[2] / weight)};
}

}  // namespace regather::imports
