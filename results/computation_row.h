// results/computation_row.h -- one parameter of an estimate of a frame's floating-point operations, after the
// paper's Table 2, and what the total becomes when it alone is divided or multiplied: docs/computation.md.
#pragma once
#include <span>
#include <string>

#include "results/column.h"
#include "results/table.h"

namespace regather::results {

struct ComputationRow {
    static const RowKind& kind();

    std::string scene;      ///< Of the capture; empty for the paper's figures.
    std::string model;      ///< Which estimate: "paper", "measured".
    std::string parameter;  ///< "gather_rays"
    std::string what;       ///< For people: "gather rays an eye ray".
    Number value;
    std::string source;  ///< Where the value is from: "Table 2", "counts.gather_rays / counts.eye_rays".
    Number factor;       ///< More than 1.
    Number rays;         ///< Of the frame.
    Number generation_flop, casting_flop, gather_flop, sampling_flop,
        caching_flop;                             ///< By the paper's categories.
    Number total_flop;                            ///< Their sum.
    Number divided_total_flop, times_total_flop;  ///< With value / factor, and with value x factor.
};

/// How far the two totals lie apart.
double swing(const ComputationRow& row);

/// A line a parameter and a column an estimate: the change of the total [%] by the division and by the
/// product, by the greatest swing of the last estimate. Parameters that change none are named below.
Table sensitivity_table(std::span<const ComputationRow> rows);

}  // namespace regather::results
