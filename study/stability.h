// study/stability.h -- stiff and extreme cases, each against an analytic or double-precision truth: measured
// error, allowed error, run time. What each group asks and why its bounds are what they are:
// docs/stability.md.
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "experiment/progress.h"
#include "results/stability_row.h"
#include "study/case.h"

namespace regather::study {

struct CaseGroup {
    std::string_view name, summary;
    std::vector<Case> (*cases)();
};

/// The one table of groups.
std::span<const CaseGroup> case_groups();

/// trace::UsageError that lists the known names.
const CaseGroup& case_group(std::string_view name);

/// Runs one case; a case that throws has failed, and `reason` is the error's message.
results::StabilityRow run_case(const CaseGroup& group, const Case& one, Effort effort);

/// Runs all cases of the groups, one after the other; a quick run leaves out those that are for a full one.
std::vector<results::StabilityRow> run_cases(std::span<const CaseGroup* const> of, Effort effort,
                                             const experiment::ProgressListener& told);

}  // namespace regather::study
