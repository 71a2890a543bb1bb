// experiment/traces/ray_job.h -- a trace of the rays of a captured trace: its queries are the rays of one
// kind, and their walks those through a hierarchy over the scene's triangles.
#pragma once
#include <filesystem>
#include <string>

#include "experiment/progress.h"

namespace regather::experiment {

struct RayJob {
    std::filesystem::path trace, folder;  ///< From, to.
    std::string rays;                     ///< Of trace::ray_kinds.
    std::string structure{"ray-bvh"};     ///< A spec of spatial/rays/ray_structures.h.
    std::string scene;   ///< A name or a file, scenes::load_scene(); empty: the trace's name.
    bool force = false;  ///< Overwrite a finished trace.
};

/// Rays are cast as the capture did (capture::RayCaster), from the geometry of the scene, whose checksum must
/// be the capture's. Columns: query_position (origin), query_direction, query_pixel, query_end, query_guess,
/// query_leaf_bvh (leaf of the hit; one more than all of them: none), walks, and the tree's. Returns figures
/// and the folder, for people. Throws trace::UsageError for an unknown kind, a spec that names no structure
/// for rays, a folder that is the trace's own and as trace::TraceWriter and scenes::load_scene();
/// trace::DataError for a trace that was not captured or has no rays of the kind, and for another scene.
std::string run(const RayJob& job, const ProgressListener& progress);

}  // namespace regather::experiment
