#include "spatial/rays/ray_recording.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "spatial/rays/ray_walk.h"

namespace regather::spatial {
namespace {

using trace::Vec3;

/// By triangle: which leaf holds it.
std::vector<std::uint32_t> leaves_of_triangles(const RayBvh& bvh) {
    std::vector<std::uint32_t> leaves;
    for (std::uint32_t b = 0; b < bvh.blocks().size(); ++b) {
        const RayBvh::Block& block = bvh.blocks()[b];
        for (std::uint32_t lane = 0; lane < block.count; ++lane) {
            if (leaves.size() <= block.triangles[lane]) leaves.resize(block.triangles[lane] + 1);
            leaves[block.triangles[lane]] = b;
        }
    }
    return leaves;
}

/// How far ahead the ray leaves the box; 0 when it does not meet it.
float way_out(const Ray& ray, const trace::Bounds3& box) {
    double in = 0, out = double{ray.farthest};
    for (int axis = 0; axis < 3; ++axis) {
        const double d = double{ray.direction[axis]}, o = double{ray.origin[axis]},
                     low = double{box.min[axis]} - o, high = double{box.max[axis]} - o;
        if (d == 0) {
            if (low > 0 || high < 0) return 0;
            continue;
        }
        in = std::max(in, std::min(low / d, high / d));
        out = std::min(out, std::max(low / d, high / d));
    }
    return in <= out && std::isfinite(out) ? static_cast<float>(out) : 0;
}

}  // namespace

RayRecording record_walks(const RayBvh& bvh, const RayTree& tree, std::span<const Ray> rays) {
    constexpr std::size_t chunk_rays = 4096;
    struct Chunk {
        std::vector<std::uint8_t> walks;
        std::uint64_t hits = 0, visited = 0;
    };
    const bool any_hit = tree.stack().any_hit;
    const bool spills = tree.range_of(trace::Region::stack).count > 0;
    const std::vector<std::uint32_t> leaf_of_triangle = leaves_of_triangles(bvh);
    RayRecording all;
    all.walk_bytes.resize(rays.size());
    all.end.resize(rays.size());
    all.leaf.assign(rays.size(), tree.leaves());
    std::vector<Chunk> chunks((rays.size() + chunk_rays - 1) / chunk_rays);
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        RayWalkRecorder recorder(tree);
        Chunk& chunk = chunks[c];
        const std::size_t first = c * chunk_rays, end = std::min(rays.size(), first + chunk_rays);
        for (std::size_t i = first; i < end; ++i) {
            const Ray& ray = rays[i];
            all.end[i] = ray.origin;
            if (ray.direction == Vec3{}) continue;
            bool hit = false;
            float distance = 0;
            if (any_hit) {
                hit = occluded(bvh, ray, recorder);
                if (hit) all.leaf[i] = recorder.last_leaf();
                distance = std::isfinite(ray.farthest) ? ray.farthest : way_out(ray, bvh.bounds());
            } else {
                const Meeting met = closest(bvh, ray, recorder);
                hit = met.found();
                if (hit) all.leaf[i] = leaf_of_triangle[met.triangle];
                distance = hit ? met.distance : way_out(ray, bvh.bounds());
            }
            all.walk_bytes[i] = recorder.finish();
            all.end[i] = ray.origin + ray.direction * distance;
            chunk.hits += hit;
        }
        chunk.walks.assign(recorder.bytes().begin(), recorder.bytes().end());
        chunk.visited = recorder.visited();
        if (!spills) return;
        // What the stack adds, the walks tell.
        const std::unique_ptr<WalkDecoder> decoder = tree.decoder();
        std::span<const std::uint8_t> walks = chunk.walks;
        chunk.visited = 0;
        for (std::size_t i = first; i < end; ++i) {
            chunk.visited += decoder->decode(walks.first(all.walk_bytes[i])).elements.size();
            walks = walks.subspan(all.walk_bytes[i]);
        }
    });
    for (const Chunk& chunk : chunks) {
        all.walks.insert(all.walks.end(), chunk.walks.begin(), chunk.walks.end());
        all.hits += chunk.hits;
        all.visited += chunk.visited;
    }
    return all;
}

}  // namespace regather::spatial
