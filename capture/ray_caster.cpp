#include "capture/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spatial/rays/cast.h"

namespace regather::capture {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

bool can_be_cast(Vec3 origin, Vec3 direction) {
    const float length2 = dot(direction, direction);
    return length2 > 0 && length2 < infinity && is_finite(origin);
}

double distance(Vec3 a, Vec3 b) {
    return length(trace::Vec3d(a) - b);
}

}  // namespace

RayCaster::RayCaster(const Scene& scene) : scene_(scene), bvh_(scene.vertices, scene.triangles) {
    const trace::Bounds3 box = scene.bounds();
    float largest = 0;
    if (!box.empty())
        for (int axis = 0; axis < 3; ++axis)
            largest = std::max({largest, std::fabs(box.min[axis]), std::fabs(box.max[axis])});
    // A scene far from the origin: a surface that almost faces along an axis of small coordinates still has a
    // share of the rounding along the others.
    far_ = std::max(trace::max_component(box.extent()), largest * 0x1p-8f);
    step_ = far_ * share_;
    largest_offset_ = std::max(step_, floats_ * 0x1p-23f * largest);
    inset_ = 4 * largest_offset_;

    corners_.reserve(scene.triangles.size());
    for (const auto& triangle : scene.triangles) {
        const Vec3 a = scene.vertices[triangle[0]], b = scene.vertices[triangle[1]],
                   c = scene.vertices[triangle[2]];
        // In double: the square of the area of a small triangle in a small scene is no float.
        const auto [x, y, z] = spatial::across(a, b, c);
        const trace::Vec3d across{x, y, z};
        const double area2 = length(across),
                     longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
        Corners corners{a, b, c, {0, 0, 1}, 0};
        if (area2 > 0) {
            corners.normal = trace::to_float({across.x / area2, across.y / area2, across.z / area2});
            corners.near_edge = static_cast<float>(std::min(1.0, double{inset_} * longest / area2));
        }
        corners_.push_back(corners);
    }
}

std::optional<spatial::Ray> RayCaster::ray(Vec3 origin, Vec3 direction) const {
    if (!can_be_cast(origin, direction)) return std::nullopt;
    return spatial::Ray{.origin = origin, .direction = direction, .nearest = largest_offset_ / 8};
}

std::optional<spatial::Ray> RayCaster::shadow_ray(Vec3 origin, Vec3 direction, float extent) const {
    if (!can_be_cast(origin, direction) || !(extent > 0)) return std::nullopt;
    return spatial::Ray{.origin = origin, .direction = direction, .farthest = extent};
}

std::optional<Hit> RayCaster::closest(Vec3 origin, Vec3 direction) const {
    const std::optional<spatial::Ray> cast = ray(origin, direction);
    if (!cast) return std::nullopt;
    const spatial::Meeting met = spatial::closest(bvh_, *cast);
    if (!met.found()) return std::nullopt;

    Hit hit;
    hit.distance = met.distance;
    hit.triangle = met.triangle;
    const Corners& at = corners_[hit.triangle];
    const auto u = static_cast<float>(met.weights[1] / met.weight_sum),
               v = static_cast<float>(met.weights[2] / met.weight_sum), w = 1 - u - v;
    hit.position = at.a * w + at.b * u + at.c * v;
    if (std::min({u, v, w}) < at.near_edge) {
        const Vec3 inwards = (at.a + at.b + at.c) * (1.0f / 3) - hit.position;
        const float distance = length(inwards);
        if (distance > 0) hit.position += inwards * std::min(1.0f, inset_ / distance);
    }
    hit.geometric_normal = at.normal;
    hit.shading_normal = at.normal;
    if (!scene_.normals.empty()) {
        const auto& corners = scene_.triangles[hit.triangle];
        const Vec3 smooth =
            scene_.normals[corners[0]] * w + scene_.normals[corners[1]] * u + scene_.normals[corners[2]] * v;
        if (dot(smooth, at.normal) > 0) hit.shading_normal = normalize(smooth);
    }
    return hit;
}

bool RayCaster::occluded(Vec3 origin, Vec3 direction, float extent) const {
    const std::optional<spatial::Ray> cast = shadow_ray(origin, direction, extent);
    return cast && spatial::occluded(bvh_, *cast);
}

}  // namespace regather::capture
