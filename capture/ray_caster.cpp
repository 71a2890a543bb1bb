#include "capture/ray_caster.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "capture/bsdf.h"

namespace regather::capture {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

bool can_be_cast(Vec3 origin, Vec3 direction) {
    const float length2 = dot(direction, direction);
    return length2 > 0 && length2 < infinity && is_finite(origin);
}

bool inside(const trace::Bounds3& box, Vec3 p) {
    return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y && p.z >= box.min.z &&
           p.z <= box.max.z;
}

using Double3 = std::array<double, 3>;

Double3 difference(Vec3 a, Vec3 b) {
    return {double{a.x} - b.x, double{a.y} - b.y, double{a.z} - b.z};
}
Double3 cross(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Double3& a) {
    return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

}  // namespace

struct RayCaster::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    Embree() = default;
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
    ~Embree() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
    bool closest(Vec3 origin, Vec3 direction, float nearest, RTCRayHit& query) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        query.ray = {.org_x = origin.x,
                     .org_y = origin.y,
                     .org_z = origin.z,
                     .tnear = nearest,
                     .dir_x = direction.x,
                     .dir_y = direction.y,
                     .dir_z = direction.z,
                     .time = 0,
                     .tfar = infinity,
                     .mask = 0xffffffffu,
                     .id = 0,
                     .flags = 0};
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &query);
        return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    void check(const char* what) const {
        if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
            throw std::runtime_error(
                fmt::format("Embree cannot {}: error {}", what, static_cast<int>(error)));
    }
};

RayCaster::RayCaster(const Scene& scene)
    : scene_(scene), bounds_(scene.bounds()), embree_(std::make_unique<Embree>()) {
    const trace::Bounds3& box = bounds_;
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

    Embree& e = *embree_;
    e.device = rtcNewDevice("isa=avx2");
    if (!e.device) throw std::runtime_error("Embree cannot be started (is this machine without AVX2?)");
    e.scene = rtcNewScene(e.device);
    rtcSetSceneFlags(e.scene, RTC_SCENE_FLAG_ROBUST);
    if (!scene.triangles.empty()) {
        const RTCGeometry mesh = rtcNewGeometry(e.device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), scene.vertices.size()));
        auto* indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), scene.triangles.size()));
        e.check("allocate the mesh");
        for (Vec3 v : scene.vertices)
            for (int axis = 0; axis < 3; ++axis) *vertices++ = v[axis];
        corners_.reserve(scene.triangles.size());
        for (const auto& triangle : scene.triangles) {
            const Vec3 a = scene.vertices[triangle[0]], b = scene.vertices[triangle[1]],
                       c = scene.vertices[triangle[2]];
            // In double: the square of the area of a small triangle in a small scene is no float.
            const Double3 ab = difference(b, a), ac = difference(c, a), across = cross(ab, ac);
            const double area2 = length(across),
                         longest = std::max({length(ab), length(ac), length(difference(c, b))});
            Corners corners{a, b, c, {0, 0, 1}, 0};
            if (area2 > 0) {
                corners.normal = {static_cast<float>(across[0] / area2),
                                  static_cast<float>(across[1] / area2),
                                  static_cast<float>(across[2] / area2)};
                corners.near_edge = static_cast<float>(std::min(1.0, double{inset_} * longest / area2));
            }
            corners_.push_back(corners);
            // Three times the same corner has no area in Embree's arithmetic either.
            for (const std::uint32_t corner : triangle) *indices++ = area2 > 0 ? corner : triangle[0];
        }
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(e.scene, mesh);
        rtcReleaseGeometry(mesh);
    }
    rtcCommitScene(e.scene);
    e.check("build the scene");
}

RayCaster::~RayCaster() = default;

std::optional<Hit> RayCaster::closest(Vec3 origin, Vec3 direction) const {
    if (!can_be_cast(origin, direction)) return std::nullopt;
    RTCRayHit query;
    if (!embree_->closest(origin, direction, largest_offset_ / 8, query)) {
        // A ray at the very point where triangles meet may slip between all of them: the signs that Embree
        // takes to belong to the edges there come from rounding. From within the scene's box only such rays
        // and those that leave the scene miss. A second one, turned by 2^-15 towards the inside (a fiftieth
        // of a pixel), meets a triangle away from its corners.
        if (!inside(bounds_, origin)) return std::nullopt;
        const Vec3 centre = (bounds_.min + bounds_.max) * 0.5f, to_centre = centre - origin;
        const float distance = length(to_centre);
        Vec3 aside = Frame(direction).tangent * 0.5f;
        if (distance > 0) aside += to_centre * (1 / distance);
        if (!embree_->closest(origin, direction + aside * 0x1p-15f, largest_offset_ / 8, query))
            return std::nullopt;
        // Only next to a corner: a ray that leaves an open scene along its own surface must not be turned
        // back into it.
        const Corners& met = corners_[query.hit.primID];
        const Vec3 point = origin + direction * query.ray.tfar;
        const float nearest = std::min({length(met.a - point), length(met.b - point), length(met.c - point)});
        if (!(nearest < query.ray.tfar * 0x1p-10f)) return std::nullopt;
    }

    Hit hit;
    hit.distance = query.ray.tfar;
    hit.triangle = query.hit.primID;
    const Corners& at = corners_[hit.triangle];
    const float u = query.hit.u, v = query.hit.v, w = 1 - u - v;
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
    if (!can_be_cast(origin, direction) || !(extent > 0)) return false;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray{.org_x = origin.x,
               .org_y = origin.y,
               .org_z = origin.z,
               .tnear = 0,
               .dir_x = direction.x,
               .dir_y = direction.y,
               .dir_z = direction.z,
               .time = 0,
               .tfar = extent,
               .mask = 0xffffffffu,
               .id = 0,
               .flags = 0};
    rtcOccluded1(embree_->scene, &context, &ray);
    return ray.tfar < 0;
}

}  // namespace regather::capture
