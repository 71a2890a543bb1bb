#include "capture/sampling/doubled_guide.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace regather::capture {

Vec3d doubled(Vec3 direction) {
    const Vec3d d = direction;
    if (!(d.z > 0)) return {0, 0, -1};
    return normalize(Vec3d{2 * d.z * d.x, 2 * d.z * d.y, d.z * d.z - d.x * d.x - d.y * d.y});
}

Vec3 halved(Vec3d on_sphere) {
    const auto [x, y, z] = on_sphere;
    const double turn2 = x * x + y * y;
    if (!(turn2 > 0)) return z > 0 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
    // Of half the angle; 1 - z or 1 + z, whichever cancels, by the other.
    const double cosine2 = z > 0 ? (1 + z) / 2 : turn2 / (2 * (1 - z)), sine2 = turn2 / (4 * cosine2);
    const double scale = std::sqrt(sine2 / turn2);
    return trace::to_float({x * scale, y * scale, std::sqrt(cosine2)});
}

Vec3d about(Vec3 axis, double below_one, double turn) {
    const Frame frame(axis);
    const double sine = std::sqrt(std::max(0.0, below_one * (2 - below_one))),
                 phi = 2 * std::numbers::pi * turn;
    return Vec3d(frame.tangent) * (sine * std::cos(phi)) + Vec3d(frame.bitangent) * (sine * std::sin(phi)) +
           Vec3d(axis) * (1 - below_one);
}

DoubledGuide::DoubledGuide(const PhotonGuide& guide, std::uint32_t photons, double floor)
    : guide_(guide),
      floor_(floor),
      found_(std::min(photons, guide.photons.size()), std::numeric_limits<float>::infinity()) {}

void DoubledGuide::look(const ShadedPoint& point) {
    frame_ = Frame(point.surface.normal);
    witnesses_.clear();
    guide_.for_each_witness(point.surface, point.position, found_, [this](Vec3 from, Vec3 power) {
        const Witness witness{doubled(frame_.to_local(from)), double{power.x} + power.y + power.z};
        if (witness.power > 0) witnesses_.push_back(witness);
    });
    even_ = witnesses_.empty() ? 1 : 1 - (1 - floor_) * fit(witnesses_);
}

// The cosine has the first rows of strata, and each lobe the next ones.
bool DoubledGuide::sample(Strata::Point place, Sampler&, GatherSample& found) const {
    const double u = place.along_rows, v = place.along_columns;
    std::size_t lobe = none;
    const Vec3d on_sphere =
        u < even_ ? about({0, 0, 1}, 2 * u / even_, v) : draw((u - even_) / (1 - even_), v, lobe);
    found.direction = frame_.to_world(halved(on_sphere));
    // Of the direction as it is rounded, so that pdf() says the same.
    const Vec3 local = frame_.to_local(found.direction);
    found.density = found.divisor = density_of(local, lobe);
    found.is_cosine = false;
    return found.density > 0;
}

double DoubledGuide::pdf(Vec3 direction) const {
    return density_of(frame_.to_local(direction), none);
}

double DoubledGuide::density_of(Vec3 local, std::size_t drawn) const {
    if (!(local.z > 0)) return 0;
    const double even = even_ / (4 * std::numbers::pi);
    return 4 * double{local.z} * (even_ < 1 ? even + (1 - even_) * density(doubled(local), drawn) : even);
}

}  // namespace regather::capture
