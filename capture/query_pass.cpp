#include "capture/query_pass.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "capture/pixel_paths.h"

namespace regather::capture {
namespace {

constexpr std::uint64_t block_pixels = 64;

template <class T>
void append_to(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void Queries::append(const Queries& other) {
    append_to(position, other.position);
    append_to(direction, other.direction);
    append_to(weight, other.weight);
    append_to(pixel, other.pixel);
    append_to(stratum, other.stratum);
    append_to(triangle, other.triangle);
    append_to(normal, other.normal);
    append_to(sample, other.sample);
    append_to(layer, other.layer);
}
void Queries::clear() {
    position.clear();
    direction.clear();
    weight.clear();
    pixel.clear();
    stratum.clear();
    triangle.clear();
    normal.clear();
    sample.clear();
    layer.clear();
}
void Rays::append(const Rays& other) {
    append_to(origin, other.origin);
    append_to(direction, other.direction);
    append_to(extent, other.extent);
    append_to(pixel, other.pixel);
}
void Rays::clear() {
    origin.clear();
    direction.clear();
    extent.clear();
    pixel.clear();
}
void OctreeSearches::add(Vec3 at, std::uint32_t of_pixel, spatial::ListWalkRecorder& walk) {
    position.push_back(at);
    pixel.push_back(of_pixel);
    walk_bytes.push_back(walk.finish());
    walks.insert(walks.end(), walk.bytes().begin(), walk.bytes().end());
    visited += walk.visited_nodes();
    walk.clear();
}

void OctreeSearches::append(const OctreeSearches& other) {
    append_to(position, other.position);
    append_to(pixel, other.pixel);
    append_to(walk_bytes, other.walk_bytes);
    append_to(walks, other.walks);
    visited += other.visited;
}
void PixelWork::append(const PixelWork& other) {
    queries.append(other.queries);
    caustic_queries.append(other.caustic_queries);
    guide_queries.append(other.guide_queries);
    for (std::size_t kind = 0; kind < rays.size(); ++kind) {
        rays[kind].append(other.rays[kind]);
        ray_counts[kind] += other.ray_counts[kind];
    }
    append_to(radiance, other.radiance);
    nonfinite += other.nonfinite;
    irradiance += other.irradiance;
    octree_searches.append(other.octree_searches);
}
void PixelWork::clear() {
    queries.clear();
    caustic_queries.clear();
    guide_queries.clear();
    for (Rays& kind : rays) kind.clear();
    ray_counts = {};
    radiance.clear();
    nonfinite = {};
    irradiance = {};
    octree_searches = {};
}

QueryPass::QueryPass(const Scene& scene, const RayCaster& caster, const LightSampler& lights,
                     const QueryConfig& config, PassParts parts)
    : scene_(scene), caster_(caster), lights_(lights), config_(config), parts_(parts) {}

void QueryPass::run(std::uint64_t first, std::uint64_t count, PixelWork& work) const {
    const std::uint64_t blocks = (count + block_pixels - 1) / block_pixels;
    std::vector<PixelWork> parts(blocks);
    tbb::parallel_for(std::uint64_t{0}, blocks, [&](std::uint64_t b) {
        PixelPaths paths(scene_, caster_, lights_, config_, parts_, parts[b]);
        const std::uint64_t end = std::min(count, (b + 1) * block_pixels);
        for (std::uint64_t i = b * block_pixels; i < end; ++i)
            paths.run(static_cast<std::uint32_t>(first + i));
    });
    work.clear();
    for (const PixelWork& part : parts) work.append(part);
}

}  // namespace regather::capture
