// experiment/traces/walk_columns.h -- the columns of a trace that a search makes: its structure's and its
// walks'.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "experiment/progress.h"
#include "spatial/photons/structures.h"
#include "trace/folder.h"

namespace regather::experiment {

/// Searches for the info.k nearest photons of each position within `radius` [scene units], writes the columns
/// and what trace.json says of them. With `candidates` also those of spatial/photons/candidate_bits.h.
/// Returns the end of a line for people, with the recall of a structure that is not exact, and figures of
/// candidates, a line each.
std::string write_walks(const spatial::StructureSpec& spec, const spatial::PhotonSearch& search,
                        std::span<const trace::Vec3> positions, float radius, bool candidates,
                        trace::TraceWriter& writer, trace::TraceInfo& info, const ProgressListener& progress);

}  // namespace regather::experiment
