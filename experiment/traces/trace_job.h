// experiment/traces/trace_job.h -- a trace of somebody else's photons and queries: columns in, tree built,
// every walk recorded.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "experiment/progress.h"

namespace regather::experiment {

struct TraceJob {
    std::filesystem::path
        columns;  ///< photon_position.npy, query_position.npy and others: docs/trace_format.md.
    std::filesystem::path folder;  ///< The trace's.
    std::uint32_t k = 100;         ///< Photons of a search.
    std::uint32_t width = 0;       ///< That query_pixel counts with [pixels]; 0: all in one row.
    double radius = 0;             ///< Of a search [units of the positions]; 0 or infinity: unlimited.
    std::string structure{"left-balanced-kd"};  ///< What is searched: a spec of spatial/photons/structures.h.
    bool candidates = false;                    ///< Write the bits of spatial/photons/candidate_bits.h, too.
    bool force = false;                         ///< Overwrite a finished trace.
};

/// Returns figures and the folder, for people. Throws trace::DataError for a column that is missing, unknown,
/// of another length or not finite; trace::UsageError as trace::TraceWriter and spatial::parse_structure().
std::string run(const TraceJob& job, const ProgressListener& progress);

}  // namespace regather::experiment
