// capture/gather_pass.h -- the photon gathers: a kNN search for each query and the radiance estimate of
// equation 2 of the paper, in any order, each result in its query's own place; and the walks that the
// searches took.
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "capture/query_pass.h"
#include "capture/radiance_estimate.h"
#include "capture/search_pass.h"
#include "spatial/photons/photon_kd.h"

namespace regather::capture {

struct GatherConfig {
    std::uint32_t k = 100;                                  ///< Photons of a gather; the paper, Table 1.
    float radius = std::numeric_limits<float>::infinity();  ///< Maximum radius of a search [scene units].
    Filter filter = Filter::none;
    bool surface_check =
        true;  ///< Photons of surfaces that face elsewhere (normals more than 60 degrees apart) are not used.
};

/// And what each search was for.
struct Gathered : Searched {
    std::vector<Vec3> radiance;  ///< Estimate towards the gather ray [W / (m^2 sr)].
};

/// `order[r]` is the query that runs r-th (in each thread's share); a permutation of the queries. Estimates
/// and walks do not depend on it, nor on the number of threads.
void gather(const Scene& scene, const spatial::PhotonKd& photons, const Queries& queries,
            std::span<const std::uint32_t> order, const GatherConfig& config, Gathered& gathered);

}  // namespace regather::capture
