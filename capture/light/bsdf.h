// capture/light/bsdf.h -- how surfaces scatter light: Lambert, Lambert plus an energy-normalised Blinn-Phong
// lobe, perfect mirrors, and smooth dielectrics. Directions have unit length and point away from the surface.
// No result is infinite or not a number for unit vectors, exponents of 1 to 1e6 and indices of 1.0001 to 5:
// angles of lobes are taken from sines in double precision, which do not cancel at their peaks.
#pragma once
#include "capture/sampler.h"
#include "scenes/scene.h"

namespace regather::capture {

using scenes::Material;
using scenes::MaterialKind;
using trace::Vec3;

inline bool is_specular(const Material& material) {
    return material.kind == MaterialKind::mirror || material.kind == MaterialKind::dielectric;
}

/// Two unit vectors that make a right-handed frame with the unit vector `normal` (Duff et al., "Building an
/// Orthonormal Basis, Revisited", JCGT 6(1), 2017).
struct Frame {
    explicit Frame(Vec3 normal);
    Vec3 to_world(Vec3 local) const { return tangent * local.x + bitangent * local.y + normal * local.z; }
    Vec3 to_local(Vec3 world) const {
        return {dot(tangent, world), dot(bitangent, world), dot(normal, world)};
    }
    Vec3 tangent, bitangent, normal;
};

/// Points in the unit disc to directions over the hemisphere with density cos / pi; u and v in [0, 1).
Vec3 cosine_hemisphere(float u, float v);

/// Norm of the lobe (n.h)^exponent: (e + 2)(e + 4) / (8 pi (2^(-e/2) + e)), so that its albedo at normal
/// incidence is 1 (Giesen, "Phong and Blinn-Phong normalization factors", 2009).
float blinn_phong_norm(float exponent);

/// f_r [1/sr] for a diffuse or glossy material; 0 when either direction is not above the surface, and for
/// specular materials.
Vec3 brdf(const Material& material, Vec3 normal, Vec3 to_light, Vec3 to_viewer);

/// Fresnel reflectance of a smooth dielectric for unpolarised light; `cos_incident` > 0, `eta` = index on the
/// far side / index on the near side. 1 at total internal reflection.
float fresnel(float cos_incident, float eta);
Vec3 reflect(Vec3 outgoing, Vec3 normal);  ///< Mirror direction of `outgoing`, both pointing away.
/// Refracted direction, pointing away on the far side; false at total internal reflection.
bool refract(Vec3 outgoing, Vec3 normal, float eta, Vec3& refracted);

/// Density [1/sr] with which sample_direction() finds `outgoing`: the cosine lobe and the half-vector lobe in
/// proportion to the channels' mean albedos. Its integral over the hemisphere is 1 less the chance that no
/// direction is found. 0 for specular and black materials, and when either direction is not above the
/// surface.
float scatter_pdf(const Material& material, Vec3 normal, Vec3 incoming, Vec3 outgoing);

/// A direction by three numbers in [0, 1); `normal` on the side of `incoming`. False: none, which counts as
/// no light (the half-vector lobe reaches below the horizon; specular and black materials have no lobe).
bool sample_direction(const Material& material, Vec3 normal, Vec3 incoming, double choice, float u, float v,
                      Vec3& direction);

/// One sampled continuation of light that came along `incoming` (pointing away from the surface).
struct Scatter {
    bool absorbed = true;
    Vec3 direction;  ///< Pointing away.
    Vec3 weight;     ///< Factor of the power that goes on, Russian roulette included.
};

/// Diffuse or glossy: goes on with the channels' mean albedo in a direction of sample_direction(), absorbed
/// otherwise. The weight is below 4.4 times the largest ratio of a channel's albedo to the mean. `normal` on
/// the side of `incoming`.
Scatter scatter(const Material& material, Vec3 normal, Vec3 incoming, Sampler& sampler);

}  // namespace regather::capture
