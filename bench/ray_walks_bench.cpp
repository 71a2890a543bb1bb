// bench/ray_walks_bench.cpp -- what it costs to record walks of rays, and to read them back, one thread: the
// eye, shadow and gather rays of the scene `room` in capture order, through the renderer's hierarchy and
// through binary, 4-wide and 8-wide nodes. Every run checks the hits and the elements that it counts. Bars:
// recording below 2 times the plain traversal; 100 M elements decoded a second.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "capture/query_pass.h"
#include "scenes/loader.h"
#include "spatial/rays/cast.h"
#include "spatial/rays/ray_recording.h"
#include "spatial/rays/ray_structures.h"
#include "spatial/rays/ray_walk.h"

namespace {

using namespace regather;
using capture::RayKind;

constexpr std::array<const char*, 4> structures{"ray-bvh", "bvh-2", "bvh-4", "bvh-8"};

struct Course {
    scenes::Scene scene = scenes::load_scene("room");
    capture::RayCaster caster{scene};
    std::array<std::vector<spatial::Ray>, 4> rays;  // by kind
    std::array<spatial::RayBvh, structures.size()> bvhs;

    Course() {
        const capture::LightSampler lights(scene);
        collect(lights, {.width = 512, .height = 512, .gather_rays = 0, .shadow_rays = 0, .seed = 1},
                RayKind::eye);
        collect(lights, {.width = 64, .height = 64, .gather_rays = 100, .shadow_rays = 16, .seed = 1},
                RayKind::gather);
        for (std::size_t s = 0; s < structures.size(); ++s)
            bvhs[s] =
                spatial::build(spatial::parse_ray_structure(structures[s]), scene.vertices, scene.triangles);
    }

private:
    void collect(const capture::LightSampler& lights, const capture::QueryConfig& config, RayKind kind) {
        capture::PixelWork work;
        capture::QueryPass(scene, caster, lights, config, {.rays = true, .caustics = false})
            .run(0, std::uint64_t{config.width} * config.height, work);
        const auto take = [&](RayKind k) {
            const capture::Rays& from = work.rays[static_cast<std::size_t>(k)];
            std::vector<spatial::Ray>& to = rays[static_cast<std::size_t>(k)];
            for (std::size_t i = 0; i < from.size(); ++i)
                if (const auto ray =
                        k == RayKind::shadow
                            ? caster.shadow_ray(from.origin[i], from.direction[i], from.extent[i])
                            : caster.ray(from.origin[i], from.direction[i]))
                    to.push_back(*ray);
        };
        take(kind);
        if (kind == RayKind::gather) take(RayKind::shadow);
    }
};

const Course& course() {
    static const Course instance;
    return instance;
}

/// One kind in one structure, recorded.
struct Run {
    const std::vector<spatial::Ray>& rays;
    const spatial::RayBvh& bvh;
    bool any_hit;
    std::shared_ptr<const spatial::RayTree> tree;
    spatial::RayRecording recording;

    explicit Run(const benchmark::State& state)
        : rays(course().rays[static_cast<std::size_t>(state.range(0))]),
          bvh(course().bvhs[static_cast<std::size_t>(state.range(1))]),
          any_hit(static_cast<RayKind>(state.range(0)) == RayKind::shadow),
          tree(spatial::tree_of(
              spatial::parse_ray_structure(structures[static_cast<std::size_t>(state.range(1))]), bvh,
              any_hit)),
          recording(spatial::record_walks(bvh, *tree, rays)) {}

    template <class Listener>
    std::uint64_t hits(const spatial::Ray& ray, Listener& listener) const {
        return any_hit ? spatial::occluded(bvh, ray, listener) : spatial::closest(bvh, ray, listener).found();
    }
    void label(benchmark::State& state, double per_run) const {
        state.SetLabel(std::string(capture::ray_kind_names[static_cast<std::size_t>(state.range(0))]) + " " +
                       structures[static_cast<std::size_t>(state.range(1))]);
        state.counters["elements a ray"] =
            static_cast<double>(recording.visited) / static_cast<double>(rays.size());
        state.counters["bytes a ray"] =
            static_cast<double>(recording.walks.size()) / static_cast<double>(rays.size());
        state.counters["per second"] =
            benchmark::Counter(per_run, benchmark::Counter::kIsIterationInvariantRate);
    }
};

void traverse(benchmark::State& state) {
    const Run run(state);
    spatial::UnheardCast nobody;
    for (auto unused : state) {
        std::uint64_t hits = 0;
        for (const spatial::Ray& ray : run.rays) hits += run.hits(ray, nobody);
        if (hits != run.recording.hits) state.SkipWithError("another number of hits");
    }
    run.label(state, static_cast<double>(run.rays.size()));
}

void record(benchmark::State& state) {
    const Run run(state);
    for (auto unused : state) {
        spatial::RayWalkRecorder recorder(*run.tree);
        std::uint64_t hits = 0, bytes = 0;
        for (const spatial::Ray& ray : run.rays) {
            hits += run.hits(ray, recorder);
            bytes += recorder.finish();
        }
        if (hits != run.recording.hits || bytes != run.recording.walks.size())
            state.SkipWithError("another number of hits or bytes");
    }
    run.label(state, static_cast<double>(run.rays.size()));
}

void decode(benchmark::State& state) {
    const Run run(state);
    const auto decoder = run.tree->decoder();
    for (auto unused : state) {
        std::span<const std::uint8_t> walks = run.recording.walks;
        std::uint64_t elements = 0;
        for (const std::uint32_t bytes : run.recording.walk_bytes) {
            elements += decoder->decode(walks.first(bytes)).elements.size();
            walks = walks.subspan(bytes);
        }
        if (elements != run.recording.visited) state.SkipWithError("another number of elements");
    }
    run.label(state, static_cast<double>(run.recording.visited));
}

#define RAYS(function)                                                                     \
    BENCHMARK(function)                                                                    \
        ->ArgsProduct({{static_cast<int>(RayKind::eye), static_cast<int>(RayKind::shadow), \
                        static_cast<int>(RayKind::gather)},                                \
                       {0, 1, 2, 3}})                                                      \
        ->Unit(benchmark::kMillisecond)
RAYS(traverse);
RAYS(record);
RAYS(decode);

}  // namespace

BENCHMARK_MAIN();
