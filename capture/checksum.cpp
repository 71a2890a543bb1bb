#include <span>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "trace/digest.h"

namespace regather::capture {
namespace {

/// Their number and themselves.
template <class T>
void add(trace::Digest& digest, const std::vector<T>& values) {
    digest.add(values.size());
    digest.add_all(std::span(values));
}

}  // namespace

std::string checksum(const Scene& scene) {
    trace::Digest digest;
    add(digest, scene.vertices);
    add(digest, scene.normals);
    add(digest, scene.triangles);
    add(digest, scene.triangle_material);
    add(digest, scene.triangle_light);
    for (const Material& material : scene.materials) {
        digest.add(material.kind);
        digest.add(material.diffuse);
        digest.add(material.specular);
        digest.add(material.exponent);
        digest.add(material.index_of_refraction);
    }
    for (const scenes::AreaLight& light : scene.lights)
        for (const Vec3 v : {light.corner, light.edge_u, light.edge_v, light.radiance})
            digest.add(v);  // a mesh is in the triangles
    for (const Vec3 v : {scene.camera.position, scene.camera.target, scene.camera.up}) digest.add(v);
    digest.add(scene.camera.vertical_fov_degrees);
    return digest.hexadecimal();
}

}  // namespace regather::capture
