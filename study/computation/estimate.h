// study/computation/estimate.h -- estimates of a frame's floating-point operations side by side: as Table 2
// and its printed figures, row by row, and how much each parameter moves the total.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "results/computation_row.h"
#include "results/table.h"
#include "study/computation/counters.h"

namespace regather::study {

/// One way of filling in the parameters.
struct ComputationEstimate {
    std::string model;  ///< "paper", "measured"
    std::string scene;  ///< Of the capture; empty: none.
    CountedValues counted;
};

/// "NAME=VALUE": Throws trace::UsageError for an unknown name (with the nearest and all known ones), a name
/// twice, and a value that is no number of the parameter's range. `option` opens the message.
struct GivenValue {
    Input input;
    double value;
};
std::vector<GivenValue> parse_values(std::span<const std::string> words, std::string_view option);

/// A row a parameter: its value, the operations, and the total with it alone divided by and times `factor`.
/// What leaves a parameter's range stays in the arithmetic: the estimate is a product.
std::vector<results::ComputationRow> sensitivity_of(const ComputationEstimate& estimate, double factor);

/// Table 2, line by line: the printed figures, and each estimate beside them. "from": of the last estimate.
results::Table table_of_estimates(std::span<const ComputationEstimate> estimates);

}  // namespace regather::study
