// spatial/photons/nearest_facing.h -- the nearest photon whose surface faces as a given one does
// (Christensen, "Faster Photon Map Global Illumination", Journal of Graphics Tools 4(3), 1999): the search of
// spatial/photons/nearest.h goes on beyond photons that face elsewhere.
#pragma once
#include <limits>
#include <optional>
#include <span>

#include "spatial/photons/nearest.h"

namespace regather::spatial {

/// Whether the normal of the photon's surface is within 60 degrees of a unit vector. A photon that does not
/// tell its normal faces everywhere.
inline bool faces(const Photon& photon, Vec3 normal) {
    constexpr float least_cosine = 0.5f;
    const Vec3 own = trace::decode_normal(photon);
    return own == Vec3{} || dot(own, normal) > least_cosine;
}

/// What a search fills: one photon, of equal distances the smaller node number.
class NearestFacing {
public:
    /// `nodes` of the tree that is searched, which outlive the object; `radius` as NearestSet has it.
    explicit NearestFacing(std::span<const Photon> nodes,
                           float radius = std::numeric_limits<float>::infinity())
        : nodes_(nodes), best_(1, radius) {}

    /// Of the searches from now on. A zero vector: photons that face anywhere.
    void look_for(Vec3 normal) { normal_ = normal; }
    std::optional<Neighbor> found() const {
        return best_.size() > 0 ? std::optional(best_[0]) : std::nullopt;
    }

    void clear() { best_.clear(); }
    float bound2() const { return best_.bound2(); }
    bool offer(float distance2, std::uint32_t node) {
        return distance2 <= best_.bound2() && (normal_ == Vec3{} || faces(nodes_[node], normal_)) &&
               best_.offer(distance2, node);
    }

private:
    std::span<const Photon> nodes_;
    NearestSet best_;
    Vec3 normal_;
};

}  // namespace regather::spatial
