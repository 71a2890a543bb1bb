// capture/sampling/doubled_guide.h -- what the strategies share whose densities are the cosine times lobes:
// the hemisphere above a surface as a whole sphere, and the photons as points on it.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "capture/sampling/gather_distribution.h"

namespace regather::capture {

using trace::Vec3d;

/// A direction w about the normal n, in a frame whose z axis is n, becomes the unit vector 2 (n.w) w - n, at
/// twice the angle: the pole stays, the horizon becomes the lower pole. As dw' = 4 cos dw, cos / pi becomes
/// the uniform density of the sphere, and a density f on it is 4 cos f above the surface: the cosine times a
/// factor, with the same integral, and nothing of it below the horizon. A direction that is not above the
/// horizon is at the lower pole.
Vec3d doubled(Vec3 direction);
/// The direction whose double that is; of the lower pole, any at the horizon.
Vec3 halved(Vec3d on_sphere);

/// The point of the sphere at 1 - cos = `below_one`, 0 to 2, from the unit vector `axis`, and `turn`, in [0,
/// 1), about it.
Vec3d about(Vec3 axis, double below_one, double turn);

/// Which of the parts, whose `up_to` ascend to 1, u in [0, 1) is in; `u` becomes how far in it, in [0, 1].
template <class Parts>
std::size_t part_of(const Parts& parts, double& u) {
    const auto found = std::partition_point(parts.begin(), parts.end() - 1,
                                            [u](const auto& part) { return part.up_to <= u; });
    const double begin = found == parts.begin() ? 0.0 : double{(found - 1)->up_to},
                 width = found->up_to - begin;
    u = width > 0 ? std::clamp((u - begin) / width, 0.0, 1.0) : 0;
    return static_cast<std::size_t>(found - parts.begin());
}

/// Where a photon came from, and how much it carried.
struct Witness {
    Vec3d place;       ///< On the doubled sphere.
    double power = 0;  ///< [any unit], above 0.
};

/// At least `floor` of the density is the cosine's, the rest of lobes on the doubled sphere.
class DoubledGuide : public GatherDistribution {
public:
    void look(const ShadedPoint& point) final;
    bool sample(Strata::Point place, Sampler& sampler, GatherSample& found) const final;
    double pdf(Vec3 direction) const final;

protected:
    /// Asks for `photons`; `floor`, 0 to 1, of the density looks at none.
    DoubledGuide(const PhotonGuide& guide, std::uint32_t photons, double floor);

    /// What lobes are made of, at least one. Gives their share, 0 to 1, of what the floor leaves.
    virtual double fit(std::span<const Witness> witnesses) = 0;
    /// A point of the sphere by a point of the unit square: lobes by `u`, in a lobe away from its axis by
    /// what is left of it and about the axis by `v`, all in order, so that points of different strata fall
    /// into different parts of the sphere. Tells which lobe it is of.
    virtual Vec3d draw(double u, double v, std::size_t& lobe) const = 0;
    /// [1/sr] On the sphere, of the lobes alone. The lobe that the point was drawn from, or none, reaches
    /// there, even where the point is rounded across its edge.
    virtual double density(Vec3d on_sphere, std::size_t drawn) const = 0;
    static constexpr std::size_t none = ~std::size_t{0};

    double floor() const { return floor_; }

private:
    /// [1/sr] Above the surface, of a direction in the frame.
    double density_of(Vec3 local, std::size_t drawn) const;

    const PhotonGuide& guide_;
    double floor_;
    double even_ = 1;  // the cosine's share
    spatial::NearestSet found_;
    std::vector<Witness> witnesses_;
    Frame frame_{{0, 0, 1}};
};

}  // namespace regather::capture
