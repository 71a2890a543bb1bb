// spatial/photons/recording.h -- searches many points of one tree, in parallel, and keeps their walks.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "spatial/photons/bucket_kd.h"
#include "spatial/photons/photon_kd.h"

namespace regather::spatial {

/// Row i belongs to point i.
struct Recording {
    std::vector<std::uint32_t> walk_bytes;  ///< Length of each walk.
    std::vector<std::uint8_t> walks;        ///< One after the other (spatial/walk.h).
    std::uint64_t found_photons = 0, visited_nodes = 0;
};

/// The walks of the `k` nearest photons within `radius` [scene units] of each point; a point that is not
/// finite has an empty walk. The same on any number of threads.
Recording record_walks(const PhotonKd& tree, std::span<const Vec3> points, std::uint32_t k, float radius);
Recording record_walks(const BucketKd& tree, std::span<const Vec3> points, std::uint32_t k, float radius);

}  // namespace regather::spatial
