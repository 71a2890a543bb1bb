// capture/light/surface.h -- the side of a surface that a ray meets, and where specular surfaces send it on.
// The photon pass and the eye paths share it: light and importance take the same turns.
#pragma once
#include "capture/light/bsdf.h"
#include "capture/ray_caster.h"

namespace regather::capture {

struct Surface {
    const Material* material;
    bool front;   ///< The ray comes from the side that the winding names; inside a dielectric otherwise.
    Vec3 side;    ///< Geometric normal on the ray's side.
    Vec3 normal;  ///< Shading normal on the ray's side; `side` where that would not face the ray.

    /// Index of refraction on the far side / on the ray's side.
    float eta() const { return front ? material->index_of_refraction : 1 / material->index_of_refraction; }
};

/// `incoming` points away from the surface, to where the ray came from.
inline Surface surface_at(const Scene& scene, const Hit& hit, Vec3 incoming) {
    const bool front = dot(incoming, hit.geometric_normal) > 0;
    const Vec3 side = front ? hit.geometric_normal : -hit.geometric_normal;
    const Vec3 smooth = front ? hit.shading_normal : -hit.shading_normal;
    return {&scene.materials[scene.triangle_material[hit.triangle]], front, side,
            dot(incoming, smooth) > 0 ? smooth : side};
}

/// Mirror direction, always on the ray's side.
inline Vec3 reflected(const Surface& at, Vec3 incoming) {
    const Vec3 direction = reflect(incoming, at.normal);
    return dot(direction, at.side) > 0 ? direction : reflect(incoming, at.side);
}

/// Refracted direction, on the far side; false at total internal reflection.
inline bool refracted(const Surface& at, Vec3 incoming, Vec3& direction) {
    return refract(incoming, at.normal, at.eta(), direction) && dot(direction, at.side) < 0;
}

}  // namespace regather::capture
