// capture/irradiance/octree_columns.h -- searches of an octree of irradiance records as a trace of visits
// (docs/bringing_walks.md).
#pragma once
#include "capture/irradiance/irradiance_octree.h"
#include "capture/query_pass.h"
#include "trace/folder.h"

namespace regather::capture {

/// Appends to the columns, and to what `info` counts.
void write_searches(trace::TraceWriter& writer, const OctreeSearches& searches, trace::TraceInfo& info);

/// Writes what was searched, and says so in `info`. The octree has not grown since.
void finish_searches(trace::TraceWriter& writer, const IrradianceOctree& octree, trace::TraceInfo& info);

}  // namespace regather::capture
