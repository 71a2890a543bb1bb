// experiment/traces/visits_job.h -- a trace of whatever another program has walked: columns of its elements
// and of its queries' visits in, list walks out. docs/bringing_walks.md.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "experiment/progress.h"

namespace regather::experiment {

struct VisitsJob {
    std::filesystem::path columns;  ///< visit_element.npy and others.
    std::filesystem::path folder;   ///< The trace's.
    std::uint32_t width = 0;        ///< That query_pixel counts with [pixels]; 0: all in one row.
    bool allow_overlaps = false;    ///< Elements may share bytes at the given addresses.
    bool force = false;             ///< Overwrite a finished trace.
};

/// Whether a folder of columns brings visits.
bool brings_visits(const std::filesystem::path& columns);

/// Elements are numbered by region, within a region as they were. Returns figures and the folder, for people.
/// Throws trace::DataError for a column that is missing, unknown or of another length, for lists that do not
/// add up, elements beyond the structure, and as spatial::check_elements(); trace::UsageError as
/// trace::TraceWriter, and for allow_overlaps without addresses.
std::string run(const VisitsJob& job, const ProgressListener& progress);

}  // namespace regather::experiment
