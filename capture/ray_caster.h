// capture/ray_caster.h -- rays against the triangles of a scene (spatial/rays/cast.h), and where the next ray
// starts. docs/stability.md has the error bounds.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "scenes/scene.h"
#include "spatial/rays/ray.h"
#include "spatial/rays/ray_bvh.h"

namespace regather::capture {

using scenes::Scene;
using trace::Vec3;

struct Hit {
    float distance = 0;  ///< Along the unit direction [scene units].
    std::uint32_t triangle = 0;
    /// From the barycentric coordinates: in the triangle's plane to rounding. Next to an edge it is moved
    /// inwards, by RayCaster::inset() at most: a ray that leaves from there starts on the inner side of the
    /// wall behind the edge, too.
    Vec3 position;
    Vec3 geometric_normal;  ///< Unit length, by the triangle's winding.
    Vec3 shading_normal;    ///< Unit length, interpolated where the mesh has normals; same side as the
                            ///< geometric one.
};

class RayCaster {
public:
    /// Triangles without any area are never hit; of triangles at the same distance the one with the smallest
    /// number is. The scene outlives the caster. Throws as spatial::RayBvh does.
    explicit RayCaster(const Scene& scene);
    RayCaster(const RayCaster&) = delete;
    RayCaster& operator=(const RayCaster&) = delete;

    /// `direction` has unit length. A zero or non-finite direction, or a non-finite origin, hits nothing.
    /// Surfaces that the origin lies on are not hit: nothing within an eighth of the farthest that offset()
    /// moves a point is. Any number of threads may call.
    std::optional<Hit> closest(Vec3 origin, Vec3 direction) const;
    bool occluded(Vec3 origin, Vec3 direction, float extent) const;

    /// What closest() and occluded() cast through the triangles; nothing when they cast nothing.
    std::optional<spatial::Ray> ray(Vec3 origin, Vec3 direction) const;
    std::optional<spatial::Ray> shadow_ray(Vec3 origin, Vec3 direction, float extent) const;
    const spatial::RayBvh& bvh() const { return bvh_; }

    /// `position` moved off the surface to the side of `normal`, farther than the rounding of any hit, so
    /// that a ray from there does not meet the same surface (Waechter and Binder, "A Fast and Reliable Method
    /// for Avoiding Self-Intersection", Ray Tracing Gems, 2019, chapter 6): a fixed step where coordinates
    /// are small, a fixed number of floats where they are large. Their two constants for "small" are lengths
    /// in metres; here they are shares of the scene's extent, and so it holds at any scale.
    Vec3 offset(Vec3 position, Vec3 normal) const {
        return {moved(position.x, normal.x), moved(position.y, normal.y), moved(position.z, normal.z)};
    }
    /// The farthest that closest() moves a hit inwards [scene units].
    float inset() const { return inset_; }

private:
    // In floats (units in the last place) beyond `far_`, as a share of `far_` within. Half of the smallest
    // step, 2^-19, is what the errors of the hit point and of its distance add up to at most
    // (docs/stability.md).
    static constexpr float floats_ = 64, share_ = 0x1p-18f;

    float moved(float coordinate, float normal) const {
        if (std::fabs(coordinate) < far_) return coordinate + step_ * normal;
        const auto floats = static_cast<std::int32_t>(floats_ * normal);
        return std::bit_cast<float>(std::bit_cast<std::int32_t>(coordinate) +
                                    (coordinate < 0 ? -floats : floats));
    }

    /// All that a hit needs of a triangle, on one or two cache lines.
    struct Corners {
        Vec3 a, b, c, normal;
        float near_edge;  ///< Barycentric coordinates below it may lie within inset() of an edge.
    };
    const Scene& scene_;
    float far_, step_, largest_offset_, inset_;
    std::vector<Corners> corners_;
    spatial::RayBvh bvh_;
};

}  // namespace regather::capture
