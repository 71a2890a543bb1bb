// replay/verification.h -- a trace held against all that it says of itself.
#pragma once
#include <cstdint>
#include <optional>

#include "replay/replay.h"
#include "trace/folder.h"

namespace regather::replay {

/// What verify() has seen and does not refuse.
struct Verified {
    std::uint64_t queries_nowhere = 0;  ///< At a position that is not finite: they find nothing.
    bool searched = false;  ///< Whether each query was searched again; trace.json must say the radius.
};

/// [scene units] How far the trace's queries were searched: infinite when unlimited; none when trace.json
/// does not say. Throws trace::DataError when it says what is no radius, or is of a capture, which says it.
std::optional<float> search_radius(const trace::TraceReader& trace);

/// Throws trace::DataError for a trace whose searches look for a surface that faces as the query's does: not
/// what searches of other structures do.
void refuse_normals(const trace::TraceReader& trace);

/// Reads every column and checks: k, size, seed and rays of trace.json against its parameters and columns;
/// checksums; the order of the tree, finite photons; pixels inside the image;
/// finite weights; unit directions; leaf labels below the number of leaves, where trace.json says it; rays;
/// lengths that add up to the walks, walks that end where their bytes end, and their sum of nodes; a bit of
/// `candidate` for each photon looked at, as many set as photons found or more; then,
/// but for a trace of rays, whose triangles it does not hold, searches each query again and compares its walk
/// and bits byte by byte, the sum of photons found, and the recall of a structure that is not exact. On all
/// cores: as long as the capture's gathering. Throws trace::DataError that names file, row, found and
/// expected.
Verified verify(trace::TraceReader& trace, const QueriesDone& progress = {});

}  // namespace regather::replay
