#include "capture/gather_pass.h"

#include <algorithm>

#include "spatial/photons/nearest.h"

namespace regather::capture {

void gather(const Scene& scene, const spatial::PhotonKd& photons, const Queries& queries,
            std::span<const std::uint32_t> order, const GatherConfig& config, Gathered& gathered) {
    const std::uint32_t k = std::min(config.k, photons.size());
    gathered.radiance.assign(queries.size(), {});
    search_all(
        order, [&] { return spatial::NearestSet(k, config.radius); },
        [&](std::uint32_t q, spatial::NearestSet& found, spatial::WalkRecorder& recorder) {
            spatial::nearest(photons, queries.position[q], found, recorder);
            const Material& material = scene.materials[scene.triangle_material[queries.triangle[q]]];
            gathered.radiance[q] =
                reflected_radiance(photons, found, {&material, queries.normal[q], -queries.direction[q]},
                                   config.filter, config.surface_check);
            return found.size();
        },
        gathered);
}

}  // namespace regather::capture
