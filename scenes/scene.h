// scenes/scene.h -- a scene in memory: triangles, materials, rectangular area lights and a pinhole camera.
// Lengths in metres, light in watts: radiance [W / (m^2 sr)], power [W], per RGB channel.
// The JSON form is documented in docs/scene_format.md; scenes/loader.h reads it.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "trace/bounds.h"
#include "trace/vec.h"

namespace regather::scenes {

using trace::Bounds3;
using trace::Vec3;

enum class MaterialKind : std::uint8_t { diffuse, glossy, mirror, dielectric };

/// Reflectances are in [0, 1] per channel; diffuse + specular <= 1 per channel (the loader refuses more).
struct Material {
    std::string name;
    MaterialKind kind = MaterialKind::diffuse;
    Vec3 diffuse{0.5f, 0.5f, 0.5f};  ///< Lambertian albedo (diffuse, glossy).
    Vec3 specular{};                 ///< Albedo of the Blinn-Phong lobe (glossy); reflectance (mirror).
    float exponent = 50;             ///< Blinn-Phong exponent (glossy), >= 1.
    float index_of_refraction = 1.5f;  ///< Inside / outside (dielectric), >= 1. Outside: against the triangle's winding.
};

/// Emits `radiance` evenly, Lambertian, on the side of cross(edge_u, edge_v). Its two triangles are in the scene too.
struct RectangleLight {
    Vec3 corner, edge_u, edge_v;
    Vec3 radiance;  ///< [W / (m^2 sr)]
    Vec3 normal() const { return trace::normalize(cross(edge_u, edge_v)); }
    float area() const { return trace::length(cross(edge_u, edge_v)); }  ///< [m^2]
    Vec3 power() const { return radiance * (3.14159265358979f * area()); }  ///< [W]: pi A L.
};

struct Camera {
    Vec3 position, target, up{0, 0, 1};
    float vertical_fov_degrees = 60;
};

/// Triangle t has vertices[triangles[t][0..2]]; counter-clockwise seen from outside (the side its normal points to).
struct Scene {
    std::string name;
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals;  ///< One a vertex, unit length; zero where the surface is flat-shaded.
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> triangle_material;  ///< Index into materials.
    std::vector<std::int32_t> triangle_light;      ///< Index into lights, -1 for none.
    std::vector<Material> materials;
    std::vector<RectangleLight> lights;
    Camera camera;
    std::uint64_t degenerate_faces_dropped = 0;  ///< Faces of mesh files without area, left out.

    Bounds3 bounds() const { return trace::bounds_of(vertices); }
};

}  // namespace regather::scenes
