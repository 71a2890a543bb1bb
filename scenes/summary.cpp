#include "scenes/summary.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace regather::scenes {

std::string kinds_of(std::span<const Material> materials) {
    constexpr std::array<std::string_view, 4> names{"diffuse", "glossy", "mirror", "dielectric"};
    std::array<std::size_t, names.size()> counts{};
    for (const Material& material : materials) ++counts[static_cast<std::size_t>(material.kind)];
    std::string text;
    for (std::size_t kind = 0; kind < counts.size(); ++kind)
        if (counts[kind] > 0)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counts[kind], names[kind]);
    return text;
}

Vec3 total_power(const Scene& scene) {
    Vec3 power;
    for (const AreaLight& light : scene.lights) power += light.power();
    return power;
}

}  // namespace regather::scenes
