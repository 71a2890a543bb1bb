// scenes/scene.h -- a scene in memory: triangles, materials, area lights and a pinhole camera with its path.
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
    float index_of_refraction =
        1.5f;  ///< Inside / outside (dielectric), >= 1. Outside: against the triangle's winding.
};

/// Emits `radiance` evenly, Lambertian, on the outside of its triangles, which are in the scene, too. A
/// rectangle (any parallelogram) emits on the side of cross(edge_u, edge_v); a mesh light is the run of
/// triangles that it names.
struct AreaLight {
    Vec3 corner, edge_u, edge_v;  ///< Of a rectangle; zero for a mesh.
    Vec3 radiance;                ///< [W / (m^2 sr)]
    std::uint32_t first_triangle = 0,
                  triangle_count = 0;  ///< Of a mesh: its triangles; a rectangle says 0, 0.
    float mesh_area = 0;               ///< Of a mesh: the sum over its triangles [m^2].

    bool is_mesh() const { return triangle_count > 0; }
    Vec3 normal() const { return trace::normalize(cross(edge_u, edge_v)); }  ///< Of a rectangle.
    float area() const { return is_mesh() ? mesh_area : trace::length(cross(edge_u, edge_v)); }  ///< [m^2]
    Vec3 power() const { return radiance * (3.14159265358979f * area()); }  ///< [W]: pi A L.
};

struct Camera {
    Vec3 position, target, up{0, 0, 1};
    float vertical_fov_degrees = 60;
};

/// A point of a camera path. Between key frames the camera moves smoothly: scenes/camera_path.h.
struct KeyFrame {
    std::uint32_t frame = 0;
    Vec3 position, target, up{0, 0, 1};
};

/// Triangle t has vertices[triangles[t][0..2]]; counter-clockwise seen from outside (the side its normal
/// points to).
struct Scene {
    std::string name;
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals;  ///< One a vertex, unit length; zero where the surface is flat-shaded.
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> triangle_material;  ///< Index into materials.
    std::vector<std::int32_t> triangle_light;      ///< Index into lights, -1 for none.
    std::vector<Material> materials;
    std::vector<AreaLight> lights;
    Camera camera;
    std::vector<KeyFrame> camera_path;  ///< By rising frame, the first is 0; empty: the camera stands still.
    std::uint32_t frames = 1;           ///< Of the camera path.
    std::string origin, licence;        ///< Where the scene is from; empty when it does not say.
    std::array<double, 3>
        recentred_by{};  ///< [m] Taken off all coordinates of the file, for the sake of floats.
    std::uint64_t degenerate_faces_dropped = 0;  ///< Faces of mesh files without area, left out.
    std::vector<std::string>
        notes;  ///< What its mesh files hold that is not taken over, "FILE: WHAT: HOW OFTEN".

    Bounds3 bounds() const { return trace::bounds_of(vertices); }
};

}  // namespace regather::scenes
