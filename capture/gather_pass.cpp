#include "capture/gather_pass.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <numbers>

#include "capture/bsdf.h"
#include "spatial/nearest.h"
#include "spatial/walk.h"

namespace regather::capture {
namespace {

constexpr std::size_t chunk_queries = 2048;

/// Equation 2: sum over the found photons of f_r(x, w_p, w) x power / area, the area being the disc around them.
Vec3 reflected_radiance(const spatial::PhotonKd& photons, const spatial::NearestSet& found, const Material& material,
                        Vec3 normal, Vec3 to_viewer) {
    const float radius2 = found.disc_radius2();
    if (!(radius2 > 0)) return {};
    const std::span<const trace::Photon> nodes = photons.nodes();
    Vec3 sum;
    if (material.kind == MaterialKind::glossy) {
        for (std::size_t i = 0; i < found.size(); ++i) {
            const trace::Photon& photon = nodes[found[i].node];
            sum += brdf(material, normal, -trace::decode_direction(photon), to_viewer) * trace::decode_power(photon.power);
        }
    } else {
        for (std::size_t i = 0; i < found.size(); ++i) {
            const trace::Photon& photon = nodes[found[i].node];
            if (dot(normal, trace::decode_direction(photon)) < 0) sum += trace::decode_power(photon.power);
        }
        sum = sum * material.diffuse * (1 / std::numbers::pi_v<float>);
    }
    return sum * (1 / (std::numbers::pi_v<float> * radius2));
}

Vec3 normal_towards(const Scene& scene, std::uint32_t triangle, Vec3 direction) {
    const auto& corners = scene.triangles[triangle];
    const Vec3 a = scene.vertices[corners[0]];
    const Vec3 normal = normalize(cross(scene.vertices[corners[1]] - a, scene.vertices[corners[2]] - a));
    return dot(normal, direction) > 0 ? normal : -normal;
}

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
    tbb::enumerable_thread_specific<Searcher> searchers(
        [&] { return Searcher{spatial::NearestSet(k, config.radius), {}}; });

    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        Searcher& searcher = searchers.local();
        searcher.recorder.clear();
        const std::size_t end = std::min(n, (c + 1) * chunk_queries);
        for (std::size_t r = c * chunk_queries; r < end; ++r) {
            const std::uint32_t q = order[r];
            spatial::nearest(photons, queries.position[q], searcher.found, searcher.recorder);
            gathered.walk_bytes[q] = searcher.recorder.finish();
            chunks[c].found += searcher.found.size();
            const Vec3 to_viewer = -queries.direction[q];
            const std::uint32_t triangle = queries.triangle[q];
            gathered.radiance[q] =
                reflected_radiance(photons, searcher.found, scene.materials[scene.triangle_material[triangle]],
                                   normal_towards(scene, triangle, to_viewer), to_viewer);
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
