// spatial/rays/ray_recording.h -- casts many rays through one hierarchy, in parallel, and keeps their walks.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "spatial/rays/cast.h"
#include "spatial/rays/ray_tree.h"

namespace regather::spatial {

/// Row i belongs to ray i.
struct RayRecording {
    std::vector<std::uint32_t> walk_bytes;  ///< Length of each walk.
    std::vector<std::uint8_t> walks;        ///< One after the other; spatial/rays/ray_walk.h has the grammar.
    /// Where the ray ends: at the hit; one that needs any hit, and has an extent, at that. A ray that meets
    /// nothing where it leaves the box of all triangles, or at its origin when that lies ahead nowhere.
    std::vector<trace::Vec3> end;
    std::vector<std::uint32_t> leaf;  ///< Number of the leaf whose triangle was hit; none: of leaves.
    std::uint64_t hits = 0;
    std::uint64_t visited = 0;  ///< Elements that the walks give.
};

/// `tree` is the shape of `bvh`; its stack says whether any hit is enough. A ray without a direction is not
/// cast and has an empty walk.
RayRecording record_walks(const RayBvh& bvh, const RayTree& tree, std::span<const Ray> rays);

}  // namespace regather::spatial
