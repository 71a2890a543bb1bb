// capture/irradiance/octree_columns.h -- searches of an octree of irradiance records, and what is inserted,
// as traces of visits (docs/bringing_walks.md).
#pragma once
#include "capture/irradiance/irradiance_octree.h"
#include "capture/irradiance/irradiance_seeding.h"
#include "capture/query_pass.h"
#include "trace/folder.h"

namespace regather::capture {

/// Appends to the columns, and to what `info` counts.
void write_searches(trace::TraceWriter& writer, const OctreeSearches& searches, trace::TraceInfo& info);

/// Where they go; a null one goes nowhere.
struct SeedingTrace {
    trace::TraceWriter* writer = nullptr;
    trace::TraceInfo& info;
};
/// Appends what the rounds of seeding looked up, and what they inserted: an insertion's walk is the cells and
/// records that it reads and writes. The elements are those of the finished octree. `image_width` [pixels].
void write_seeding(const IrradianceSeeding& seeding, std::uint32_t image_width, SeedingTrace lookups,
                   SeedingTrace insertions);

/// Writes what was searched, and says so in `info`. The octree has not grown since.
void finish_searches(trace::TraceWriter& writer, const IrradianceOctree& octree, trace::TraceInfo& info);

}  // namespace regather::capture
