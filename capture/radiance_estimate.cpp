#include "capture/radiance_estimate.h"

#include <cmath>
#include <numbers>

#include "spatial/photons/nearest_facing.h"

namespace regather::capture {
namespace {

constexpr float cone_slope = 1 / 1.1f, beta = 1.953f;

struct Even {
    float operator()(float) const { return 1; }
};
struct Cone {
    float operator()(float share2) const {
        return (1 - cone_slope * std::sqrt(share2)) * (1 / (1 - cone_slope * (2 / 3.0f)));
    }
};
struct Gaussian {
    float floor = 1 - 1 / (1 - std::exp(-beta)), peak = 1 / (1 - std::exp(-beta));
    float norm = 1 / (floor + peak * (1 - std::exp(-beta / 2)) * (2 / beta));
    float operator()(float share2) const { return norm * (floor + peak * std::exp(-beta / 2 * share2)); }
};

template <class Weight>
Vec3 weighted_sum(const spatial::PhotonKd& photons, const spatial::NearestSet& found, const GatherPoint& at,
                  float radius2, bool surface_check, const Weight& weight) {
    const std::span<const trace::Photon> nodes = photons.nodes();
    const bool diffuse = at.material->kind == MaterialKind::diffuse;
    const float per_radius2 = 1 / radius2;
    // In double: a sum of a million floats would be off by parts in a hundred.
    double red = 0, green = 0, blue = 0;
    for (std::size_t i = found.full() && found.size() > 1 ? 1 : 0; i < found.size(); ++i) {
        const spatial::Neighbor neighbor = found[i];
        const trace::Photon& photon = nodes[neighbor.node];
        if (!is_used(photon, at, surface_check)) continue;
        const Vec3 power = trace::decode_power(photon.power) * weight(neighbor.distance2 * per_radius2);
        const Vec3 part =
            diffuse ? power
                    : brdf(*at.material, at.normal, -trace::decode_direction(photon), at.to_viewer) * power;
        red += static_cast<double>(part.x);
        green += static_cast<double>(part.y);
        blue += static_cast<double>(part.z);
    }
    const Vec3 sum{static_cast<float>(red), static_cast<float>(green), static_cast<float>(blue)};
    return diffuse ? sum * at.material->diffuse * (1 / std::numbers::pi_v<float>) : sum;
}

}  // namespace

float filter_weight(Filter filter, float share2) {
    return filter == Filter::none   ? Even{}(share2)
           : filter == Filter::cone ? Cone{}(share2)
                                    : Gaussian{}(share2);
}

bool is_used(const trace::Photon& photon, const GatherPoint& at, bool surface_check) {
    if (!(dot(at.normal, trace::decode_direction(photon)) < 0)) return false;
    return !surface_check || spatial::faces(photon, at.normal);
}

Vec3 reflected_radiance(const spatial::PhotonKd& photons, const spatial::NearestSet& found,
                        const GatherPoint& at, Filter filter, bool surface_check) {
    const float radius2 = found.disc_radius2();
    if (!(radius2 > 0)) return {};
    const auto sum = [&](const auto& weight) {
        return weighted_sum(photons, found, at, radius2, surface_check, weight);
    };
    const Vec3 total = filter == Filter::none   ? sum(Even{})
                       : filter == Filter::cone ? sum(Cone{})
                                                : sum(Gaussian{});
    return total * (1 / (std::numbers::pi_v<float> * radius2));
}

}  // namespace regather::capture
