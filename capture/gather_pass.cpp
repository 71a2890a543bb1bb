#include "capture/gather_pass.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

#include "spatial/photons/nearest.h"
#include "spatial/walk.h"

namespace regather::capture {
namespace {

constexpr std::size_t chunk_queries = 2048;

struct Chunk {
    std::vector<std::uint8_t> walks;
    std::uint64_t found = 0, visited = 0;
};

}  // namespace

void gather(const Scene& scene, const spatial::PhotonKd& photons, const Queries& queries,
            std::span<const std::uint32_t> order, const GatherConfig& config, Gathered& gathered) {
    const std::size_t n = queries.size();
    const std::uint32_t k = std::min(config.k, photons.size());
    gathered.radiance.assign(n, {});
    gathered.walk_bytes.assign(n, 0);
    std::vector<Chunk> chunks((n + chunk_queries - 1) / chunk_queries);
    struct Searcher {
        spatial::NearestSet found;
        spatial::WalkRecorder recorder;
    };
    tbb::enumerable_thread_specific<Searcher> searchers([&] {
        return Searcher{spatial::NearestSet(k, config.radius), {}};
    });

    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        Searcher& searcher = searchers.local();
        searcher.recorder.clear();
        const std::size_t end = std::min(n, (c + 1) * chunk_queries);
        for (std::size_t r = c * chunk_queries; r < end; ++r) {
            const std::uint32_t q = order[r];
            spatial::nearest(photons, queries.position[q], searcher.found, searcher.recorder);
            gathered.walk_bytes[q] = searcher.recorder.finish();
            chunks[c].found += searcher.found.size();
            const Material& material = scene.materials[scene.triangle_material[queries.triangle[q]]];
            gathered.radiance[q] = reflected_radiance(photons, searcher.found,
                                                      {&material, queries.normal[q], -queries.direction[q]},
                                                      config.filter, config.surface_check);
        }
        const std::span<const std::uint8_t> walks = searcher.recorder.bytes();
        chunks[c].walks.assign(walks.begin(), walks.end());
        chunks[c].visited = searcher.recorder.visited_nodes();
    });

    std::vector<std::uint64_t> place(n);
    std::uint64_t bytes = 0;
    for (std::size_t q = 0; q < n; ++q) {
        place[q] = bytes;
        bytes += gathered.walk_bytes[q];
    }
    gathered.walks.resize(bytes);
    gathered.found_photons = gathered.visited_nodes = 0;
    for (const Chunk& chunk : chunks) {
        gathered.found_photons += chunk.found;
        gathered.visited_nodes += chunk.visited;
    }
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        const std::uint8_t* from = chunks[c].walks.data();
        const std::size_t end = std::min(n, (c + 1) * chunk_queries);
        for (std::size_t r = c * chunk_queries; r < end; ++r) {
            const std::uint32_t q = order[r];
            if (gathered.walk_bytes[q] == 0) continue;
            std::memcpy(gathered.walks.data() + place[q], from, gathered.walk_bytes[q]);
            from += gathered.walk_bytes[q];
        }
    });
}

}  // namespace regather::capture
