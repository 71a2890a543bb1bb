// capture/ray_caster.h -- rays against the triangles of a scene, by Embree 3. Embree is held to AVX2 kernels, so that a machine
// with wider vectors finds the same hits to the last bit.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "scenes/scene.h"

namespace regather::capture {

using scenes::Scene;
using trace::Vec3;

struct Hit {
    float distance = 0;          ///< Along the unit direction [scene units].
    std::uint32_t triangle = 0;
    Vec3 position;               ///< From the barycentric coordinates: on the triangle to rounding.
    Vec3 geometric_normal;       ///< Unit length, by the triangle's winding.
    Vec3 shading_normal;         ///< Unit length, interpolated where the mesh has normals; same side as the geometric one.
};

class RayCaster {
public:
    /// The scene outlives the caster. Throws std::runtime_error with Embree's message.
    explicit RayCaster(const Scene& scene);
    ~RayCaster();
    RayCaster(const RayCaster&) = delete;
    RayCaster& operator=(const RayCaster&) = delete;

    /// `direction` has unit length. Any number of threads may call.
    std::optional<Hit> closest(Vec3 origin, Vec3 direction) const;
    bool occluded(Vec3 origin, Vec3 direction, float extent) const;

    /// `position` moved off the surface to the side of `normal`, by 2^-17 of the scene's largest coordinate: more than
    /// the rounding of any hit, so that a ray from there does not meet the same surface.
    Vec3 offset(Vec3 position, Vec3 normal) const { return position + normal * epsilon_; }

private:
    struct Embree;
    const Scene& scene_;
    float epsilon_;
    std::unique_ptr<Embree> embree_;
};

}  // namespace regather::capture
