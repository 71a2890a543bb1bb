// study/computation/computation_job.h -- Table 2 of the paper as it is printed and as its rows multiply, and
// of the traces of a capture.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "experiment/progress.h"
#include "results/computation_row.h"
#include "results/table.h"
#include "trace/json.h"

namespace regather::study {

struct ComputationJob {
    std::vector<std::filesystem::path> traces;  ///< As open_traces(); none: the paper alone.
    std::vector<std::string> settings;          ///< "NAME=VALUE", which stand above all else.
    std::string sampling{};  ///< As sampling_operations(), whose table is told; empty: none. Not with traces.
    double factor = 2;       ///< That each parameter alone is divided by and multiplied with.
};

struct ComputationResult {
    std::vector<results::ComputationRow> rows;  ///< ComputationEstimate by estimate, by parameter.
    std::vector<results::Table> tables;
    std::string checksum;    ///< Of the traces; empty without.
    trace::Json parameters;  ///< Of the traces, by part; null without.
};

/// Estimates: "paper", Table 2's rows; "paper-102", with what its printed sums need; "set", the paper's with
/// the settings, where there are any and no traces, and with the FLOP of `sampling` unless that is "all"; of
/// traces "counted", their counts with the paper's
/// constants, and "measured", with measured ones where there are any, both with the settings. Throws
/// trace::UsageError for a factor that is not from above 1 to 1000, and as parse_values(), open_traces() and
/// measured_values().
ComputationResult run(const ComputationJob& job, const experiment::ProgressListener& progress);

}  // namespace regather::study
