#include <fmt/format.h>
#include <xxhash.h>

#include <string>
#include <type_traits>
#include <vector>

#include "capture/capture.h"

namespace regather::capture {
namespace {

class Digest {
public:
    Digest() : state_(XXH3_createState()) { XXH3_64bits_reset(state_); }
    Digest(const Digest&) = delete;
    Digest& operator=(const Digest&) = delete;
    ~Digest() { XXH3_freeState(state_); }
    template <class T>
    void add(const T& value) {
        static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, float> ||
                      std::is_same_v<T, Vec3>);
        XXH3_64bits_update(state_, &value, sizeof value);
    }
    template <class T>
    void add(const std::vector<T>& values) {
        add(values.size());
        XXH3_64bits_update(state_, values.data(), values.size() * sizeof(T));
    }
    std::string text() const { return fmt::format("{:016x}", XXH3_64bits_digest(state_)); }

private:
    XXH3_state_t* state_;
};

}  // namespace

std::string checksum(const Scene& scene) {
    Digest digest;
    digest.add(scene.vertices);
    digest.add(scene.normals);
    digest.add(scene.triangles);
    digest.add(scene.triangle_material);
    digest.add(scene.triangle_light);
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
    return digest.text();
}

}  // namespace regather::capture
