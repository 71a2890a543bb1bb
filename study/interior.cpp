#include "study/interior.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

#include "capture/view_plane.h"

namespace regather::study {
namespace {

using capture::Hit;
using trace::Vec3;

bool holds_photons(const scenes::Scene& scene, std::uint32_t triangle) {
    const scenes::MaterialKind kind = scene.materials[scene.triangle_material[triangle]].kind;
    return kind == scenes::MaterialKind::diffuse || kind == scenes::MaterialKind::glossy;
}

class Probe {
public:
    Probe(const scenes::Scene& scene, const capture::RayCaster& caster, float radius)
        : scene_(scene), caster_(caster), radius_(radius) {}

    bool is_interior(Vec3 eye, Vec3 direction) const {
        const auto hit = caster_.closest(eye, direction);
        if (!hit || !usable(hit->triangle)) return false;
        Vec3 normal = hit->geometric_normal;
        if (dot(normal, direction) > 0) normal = -normal;
        const Vec3 across =
            normalize(cross(normal, std::abs(normal.z) < 0.9f ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
        const Vec3 along = cross(normal, across);
        for (const float reach : {0.5f, 1.0f})
            for (int i = 0; i < 16; ++i) {
                const float angle = static_cast<float>(i) * (std::numbers::pi_v<float> / 8);
                const Vec3 way = across * std::cos(angle) + along * std::sin(angle);
                if (!is_flat(hit->position, normal, way, reach * radius_)) return false;
            }
        return true;
    }

private:
    bool usable(std::uint32_t triangle) const {
        return holds_photons(scene_, triangle) && scene_.triangle_light[triangle] < 0;
    }
    /// The surface goes on, level, for `reach` on the way, with nothing over it.
    bool is_flat(Vec3 from, Vec3 normal, Vec3 way, float reach) const {
        const float height = 0.05f * radius_;
        const Vec3 raised = from + normal * height;
        if (caster_.occluded(raised, way, reach)) return false;
        const auto below = caster_.closest(raised + way * reach, -normal);
        return below && usable(below->triangle) && std::abs(below->distance - height) < 0.1f * height &&
               std::abs(dot(below->geometric_normal, normal)) > 0.999f;
    }

    const scenes::Scene& scene_;
    const capture::RayCaster& caster_;
    float radius_;
};

}  // namespace

std::vector<std::uint8_t> interior(const scenes::Scene& scene, const capture::RayCaster& caster,
                                   std::uint32_t width, std::uint32_t height, double radius) {
    const capture::ViewPlane plane(scene.camera, width, height);
    const Probe probe(scene, caster, static_cast<float>(radius));
    std::vector<std::uint8_t> mask(std::size_t{width} * height);
    tbb::parallel_for(0u, height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < width; ++x)
            mask[std::size_t{y} * width + x] = probe.is_interior(
                scene.camera.position,
                plane.direction(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
    });
    return mask;
}

}  // namespace regather::study
