// experiment/parts.h -- the rows of an experiment on one trace, made part by part; what is finished is kept
// and not made again. A part is the rows of one trial in one layout; besides, what all trials in a layout
// share: compulsory traffic, and the counts that no order changes.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "experiment/progress.h"
#include "results/row.h"
#include "trace/folder.h"

namespace regather::experiment {

struct PartStore {
    std::filesystem::path folder;  ///< For the files: made when missing.
    std::string revision;          ///< Of the code: parts of another one are made again.
};

/// Layout by layout the rows of all trials, in their order. `layouts` are specs that suit the trace
/// (replay/layouts/catalogue.h). A part is known by all that it depends on: code, trace, structure, layout,
/// ordering (a library by its bytes), caches, method. Missing trials are replayed on all cores, as many at
/// once as there are threads and as hold their permutations in 4 GiB; a listener that throws ends it with all
/// finished parts kept.
std::vector<results::Row> rows_of(trace::TraceReader& trace, std::span<const std::string> layouts,
                                  const Experiment& experiment, const PartStore& store,
                                  const ProgressListener& progress);

}  // namespace regather::experiment
