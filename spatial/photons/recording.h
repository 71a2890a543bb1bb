// spatial/photons/recording.h -- searches many points of one tree, in parallel, and keeps their walks.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "spatial/photons/block_hashing.h"
#include "spatial/photons/bucket_kd.h"
#include "spatial/photons/hashed_grid.h"
#include "spatial/photons/photon_bvh.h"
#include "spatial/photons/photon_grid.h"
#include "spatial/photons/photon_kd.h"
#include "spatial/photons/photon_octree.h"

namespace regather::spatial {

/// Row i belongs to point i.
struct Recording {
    std::vector<std::uint32_t> walk_bytes;  ///< Length of each walk.
    /// One after the other (spatial/walk.h, list_walk.h, photons/found_walk.h).
    std::vector<std::uint8_t> walks;
    std::uint64_t found_photons = 0, visited_nodes = 0;
    /// Of spatial/photons/candidate_bits.h, where they are told: bytes of each point's bits, and the bits.
    std::vector<std::uint32_t> candidate_bytes;
    std::vector<std::uint8_t> candidates;
};

/// What a recording tells besides walks.
struct Telling {
    bool found = false;       ///< Walks as found_walk.h has them; visited_nodes counts an element for each
                              ///< photon found.
    bool candidates = false;  ///< The bits of candidate_bits.h.
};

/// The walks of the `k` nearest photons within `radius` [scene units] of each point; a point that is not
/// finite has an empty walk. The same on any number of threads.
/// Tree: PhotonKd, BucketKd, PhotonGrid, HashedGrid, PhotonOctree, PhotonBvh or BlockHashing.
template <class Tree>
Recording record_walks(const Tree& tree, std::span<const Vec3> points, std::uint32_t k, float radius,
                       Telling telling = {});

/// The walks of the nearest photon within `radius` of each point whose surface faces as the point's does
/// (spatial/photons/nearest_facing.h); `normals` has a row for each point.
Recording record_facing(const PhotonKd& tree, std::span<const Vec3> points, std::span<const Vec3> normals,
                        float radius);

}  // namespace regather::spatial
