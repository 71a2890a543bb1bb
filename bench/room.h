// bench/room.h -- what the benchmarks measure on: the scene `room` with 1 M photons, k = 100, and the queries
// of 45 x 45 pixels x 100 gather rays, with their walks.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "capture/photon_pass.h"
#include "capture/query_pass.h"
#include "reorder/catalogue.h"
#include "scenes/loader.h"
#include "spatial/photons/recording.h"

namespace regather::bench {

inline constexpr std::uint32_t photon_count = 1'000'000, k = 100;

/// The scene `room` with the paper's photons and gathers, at 45 x 45 pixels.
struct Room {
    std::vector<trace::Photon> heap;
    capture::Queries queries;
    spatial::Recording recording;

    Room() {
        const scenes::Scene scene = scenes::load_scene("room");
        const capture::RayCaster caster(scene);
        const capture::LightSampler lights(scene);
        heap = spatial::left_balanced(
            capture::trace_photons(scene, caster, lights, {.photons = photon_count, .seed = 1}).photons);
        capture::PixelWork work;
        const capture::QueryConfig config{
            .width = 45, .height = 45, .gather_rays = 100, .shadow_rays = 0, .max_specular = 16, .seed = 1};
        capture::QueryPass(scene, caster, lights, config, {}).run(0, 45 * 45, work);
        queries = std::move(work.queries);
        recording = spatial::record_walks(spatial::PhotonKd(heap), queries.position, k,
                                          std::numeric_limits<float>::infinity());
    }
    std::vector<std::uint32_t> permutation(const char* ordering) const {
        const reorder::Workload work{.position = queries.position,
                                     .direction = queries.direction,
                                     .pixel = queries.pixel,
                                     .leaf_kd = {},
                                     .leaf_bvh = {},
                                     .bounds = trace::bounds_of(queries.position),
                                     .image_width = 45,
                                     .image_height = 45};
        return reorder::order(*reorder::make_ordering(ordering), work).permutation;
    }
};

inline const Room& room() {
    static const Room instance;
    return instance;
}

}  // namespace regather::bench
