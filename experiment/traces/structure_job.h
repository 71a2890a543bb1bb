// experiment/traces/structure_job.h -- the queries of a finished trace searched again in another structure:
// the same photons and queries, other walks.
#pragma once
#include <filesystem>
#include <string>

#include "experiment/progress.h"

namespace regather::experiment {

struct StructureJob {
    std::filesystem::path trace, folder;  ///< From, to.
    std::string structure;                ///< A spec of spatial/photons/structures.h.
    bool candidates = false;              ///< Write the bits of spatial/photons/candidate_bits.h, too.
    bool force = false;                   ///< Overwrite a finished trace.
};

/// With the trace's own k and radius; every other column is taken over. Returns figures and the folder, for
/// people. Throws trace::UsageError for a spec that names no structure, for a folder that is the trace's own
/// and as trace::TraceWriter; trace::DataError for a trace that does not say its radius.
std::string run(const StructureJob& job, const ProgressListener& progress);

/// Whether the folder holds whole what run() would write. Throws as run() for the spec and the trace, not for
/// what lies in the folder.
bool is_done(const StructureJob& job);

}  // namespace regather::experiment
