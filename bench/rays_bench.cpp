// bench/rays_bench.cpp -- the renderer's rays beside bare Embree, one thread: the eye, shadow and gather rays
// of the scene `room` in capture order, (a) by a loop of rtcIntersect1 or rtcOccluded1 over an Embree scene
// in robust mode, (b) by RayCaster, which also finds position and normals. Both must find the same triangles,
// or ones at the same distance: where triangles meet, Embree takes either. Bar: (b) within 1.3 times (a) for
// eye and shadow rays, 1.6 times for gather rays.
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "capture/query_pass.h"
#include "scenes/loader.h"

namespace {

using namespace regather;
using capture::RayKind;

constexpr std::uint32_t nothing = 0xffffffffu;

/// Embree over the triangles of a scene.
class Bare {
public:
    explicit Bare(const scenes::Scene& scene)
        : device_(rtcNewDevice("isa=avx2")), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(trace::Vec3), scene.vertices.size()));
        auto* indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), scene.triangles.size()));
        for (const trace::Vec3 v : scene.vertices)
            for (int axis = 0; axis < 3; ++axis) *vertices++ = v[axis];
        for (const auto& triangle : scene.triangles)
            for (const std::uint32_t corner : triangle) *indices++ = corner;
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
        rtcCommitScene(scene_);
        if (rtcGetDeviceError(device_) != RTC_ERROR_NONE)
            throw std::runtime_error("Embree cannot build the scene");
    }
    Bare(const Bare&) = delete;
    Bare& operator=(const Bare&) = delete;
    ~Bare() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    std::uint32_t closest(trace::Vec3 origin, trace::Vec3 direction) const {
        return closest_hit(origin, direction).hit.primID;
    }
    /// primID is `nothing` where nothing is hit.
    RTCRayHit closest_hit(trace::Vec3 origin, trace::Vec3 direction) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit query;
        query.ray = ray(origin, direction, std::numeric_limits<float>::infinity());
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        query.hit.primID = nothing;
        rtcIntersect1(scene_, &context, &query);
        return query;
    }
    bool occluded(trace::Vec3 origin, trace::Vec3 direction, float extent) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRay query = ray(origin, direction, extent);
        rtcOccluded1(scene_, &context, &query);
        return query.tfar < 0;
    }

private:
    static RTCRay ray(trace::Vec3 origin, trace::Vec3 direction, float extent) {
        return {.org_x = origin.x,
                .org_y = origin.y,
                .org_z = origin.z,
                .tnear = 0,
                .dir_x = direction.x,
                .dir_y = direction.y,
                .dir_z = direction.z,
                .time = 0,
                .tfar = extent,
                .mask = nothing,
                .id = 0,
                .flags = 0};
    }
    RTCDevice device_;
    RTCScene scene_;
};

/// The rays, and what each of the two finds.
struct Course {
    scenes::Scene scene = scenes::load_scene("room");
    capture::RayCaster caster{scene};
    Bare bare{scene};
    std::array<capture::Rays, 4> rays;
    std::array<std::vector<std::uint32_t>, 4> found_by_bare, found_by_caster;

    Course() {
        const capture::LightSampler lights(scene);
        collect(lights, {.width = 512, .height = 512, .gather_rays = 0, .shadow_rays = 0, .seed = 1},
                RayKind::eye);
        collect(lights, {.width = 64, .height = 64, .gather_rays = 100, .shadow_rays = 16, .seed = 1},
                RayKind::gather);
        for (std::size_t kind = 0; kind < rays.size(); ++kind)
            for (std::size_t i = 0; i < rays[kind].size(); ++i)
                compare(kind, rays[kind].origin[i], rays[kind].direction[i], rays[kind].extent[i]);
    }

private:
    void compare(std::size_t kind, trace::Vec3 origin, trace::Vec3 direction, float extent) {
        if (static_cast<RayKind>(kind) == RayKind::shadow) {
            found_by_bare[kind].push_back(bare.occluded(origin, direction, extent));
            found_by_caster[kind].push_back(caster.occluded(origin, direction, extent));
            if (found_by_bare[kind].back() != found_by_caster[kind].back())
                throw std::runtime_error("a shadow ray that only one of the two finds occluded");
            return;
        }
        const RTCRayHit theirs = bare.closest_hit(origin, direction);
        const auto ours = caster.closest(origin, direction);
        found_by_bare[kind].push_back(theirs.hit.primID);
        found_by_caster[kind].push_back(ours ? ours->triangle : nothing);
        if (found_by_bare[kind].back() != found_by_caster[kind].back() &&
            !(ours && std::fabs(ours->distance - theirs.ray.tfar) <= 1e-5f * ours->distance))
            throw std::runtime_error(
                "a ray for which the two find other triangles, not at the same distance");
    }
    void collect(const capture::LightSampler& lights, const capture::QueryConfig& config, RayKind kind) {
        capture::PixelWork work;
        capture::QueryPass(scene, caster, lights, config, {.rays = true, .caustics = false})
            .run(0, std::uint64_t{config.width} * config.height, work);
        const auto take = [&](RayKind k) {
            rays[static_cast<std::size_t>(k)] = std::move(work.rays[static_cast<std::size_t>(k)]);
        };
        take(kind);
        if (kind == RayKind::gather) take(RayKind::shadow);
    }
};

const Course& course() {
    static const Course instance;
    return instance;
}

/// cast(origin, direction, extent) -> what `found` has, for every ray of the kind.
template <class Cast>
void race(benchmark::State& state, RayKind kind, const std::array<std::vector<std::uint32_t>, 4>& found,
          Cast&& cast) {
    const capture::Rays& rays = course().rays[static_cast<std::size_t>(kind)];
    const std::vector<std::uint32_t>& expected = found[static_cast<std::size_t>(kind)];
    for (auto unused : state) {
        std::size_t others = 0;
        for (std::size_t i = 0; i < rays.size(); ++i)
            others += cast(rays.origin[i], rays.direction[i], rays.extent[i]) != expected[i];
        if (others > 0) state.SkipWithError("another triangle");
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rays.size()));
    state.counters["a ray"] =
        benchmark::Counter(static_cast<double>(rays.size()),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void bare_closest(benchmark::State& state, RayKind kind) {
    race(state, kind, course().found_by_bare, [&](trace::Vec3 origin, trace::Vec3 direction, float) {
        return course().bare.closest(origin, direction);
    });
}
void caster_closest(benchmark::State& state, RayKind kind) {
    race(state, kind, course().found_by_caster, [&](trace::Vec3 origin, trace::Vec3 direction, float) {
        auto hit = course().caster.closest(origin, direction);
        benchmark::DoNotOptimize(hit);  // position and normals are wanted, too
        return hit ? hit->triangle : nothing;
    });
}
void bare_occluded(benchmark::State& state) {
    race(state, RayKind::shadow, course().found_by_bare,
         [&](trace::Vec3 origin, trace::Vec3 direction, float extent) {
             return std::uint32_t{course().bare.occluded(origin, direction, extent)};
         });
}
void caster_occluded(benchmark::State& state) {
    race(state, RayKind::shadow, course().found_by_caster,
         [&](trace::Vec3 origin, trace::Vec3 direction, float extent) {
             return std::uint32_t{course().caster.occluded(origin, direction, extent)};
         });
}

#define RAYS(...) __VA_ARGS__->Unit(benchmark::kMillisecond)
RAYS(BENCHMARK_CAPTURE(bare_closest, eye, RayKind::eye));
RAYS(BENCHMARK_CAPTURE(caster_closest, eye, RayKind::eye));
RAYS(BENCHMARK(bare_occluded));
RAYS(BENCHMARK(caster_occluded));
RAYS(BENCHMARK_CAPTURE(bare_closest, gather, RayKind::gather));
RAYS(BENCHMARK_CAPTURE(caster_closest, gather, RayKind::gather));

}  // namespace

BENCHMARK_MAIN();
