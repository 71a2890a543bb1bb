#include "capture/ray_caster.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace regather::capture {

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
    void check(const char* what) const {
        if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
            throw std::runtime_error(fmt::format("Embree cannot {}: error {}", what, static_cast<int>(error)));
    }
};

RayCaster::RayCaster(const Scene& scene) : scene_(scene), embree_(std::make_unique<Embree>()) {
    const trace::Bounds3 box = scene.bounds();
    float largest = 0;
    if (!box.empty())
        for (int axis = 0; axis < 3; ++axis)
            largest = std::max({largest, std::fabs(box.min[axis]), std::fabs(box.max[axis])});
    epsilon_ = largest * 0x1p-17f;

    Embree& e = *embree_;
    e.device = rtcNewDevice("isa=avx2");
    if (!e.device) throw std::runtime_error("Embree cannot be started (is this machine without AVX2?)");
    e.scene = rtcNewScene(e.device);
    rtcSetSceneFlags(e.scene, RTC_SCENE_FLAG_ROBUST);
    if (!scene.triangles.empty()) {
        const RTCGeometry mesh = rtcNewGeometry(e.device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), scene.vertices.size()));
        auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), scene.triangles.size()));
        e.check("allocate the mesh");
        for (Vec3 v : scene.vertices)
            for (int axis = 0; axis < 3; ++axis) *vertices++ = v[axis];
        for (const auto& triangle : scene.triangles)
            for (std::uint32_t corner : triangle) *indices++ = corner;
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(e.scene, mesh);
        rtcReleaseGeometry(mesh);
    }
    rtcCommitScene(e.scene);
    e.check("build the scene");
}

RayCaster::~RayCaster() = default;

std::optional<Hit> RayCaster::closest(Vec3 origin, Vec3 direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = {.org_x = origin.x, .org_y = origin.y, .org_z = origin.z, .tnear = 0,
                 .dir_x = direction.x, .dir_y = direction.y, .dir_z = direction.z, .time = 0,
                 .tfar = std::numeric_limits<float>::infinity(), .mask = 0xffffffffu, .id = 0, .flags = 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

    Hit hit;
    hit.distance = query.ray.tfar;
    hit.triangle = query.hit.primID;
    const auto& corners = scene_.triangles[hit.triangle];
    const Vec3 a = scene_.vertices[corners[0]], b = scene_.vertices[corners[1]], c = scene_.vertices[corners[2]];
    const float u = query.hit.u, v = query.hit.v, w = 1 - u - v;
    hit.position = a * w + b * u + c * v;
    hit.geometric_normal = normalize(cross(b - a, c - a));
    hit.shading_normal = hit.geometric_normal;
    if (!scene_.normals.empty()) {
        const Vec3 smooth = scene_.normals[corners[0]] * w + scene_.normals[corners[1]] * u +
                            scene_.normals[corners[2]] * v;
        if (dot(smooth, hit.geometric_normal) > 0) hit.shading_normal = normalize(smooth);
    }
    return hit;
}

bool RayCaster::occluded(Vec3 origin, Vec3 direction, float extent) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray{.org_x = origin.x, .org_y = origin.y, .org_z = origin.z, .tnear = 0,
               .dir_x = direction.x, .dir_y = direction.y, .dir_z = direction.z, .time = 0,
               .tfar = extent, .mask = 0xffffffffu, .id = 0, .flags = 0};
    rtcOccluded1(embree_->scene, &context, &ray);
    return ray.tfar < 0;
}

}  // namespace regather::capture
