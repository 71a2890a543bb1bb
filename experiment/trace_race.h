// experiment/trace_race.h -- a race (race.h) of the queries of a trace: from its columns to rows.
#pragma once
#include <cstdint>
#include <vector>

#include "experiment/measurement.h"
#include "experiment/progress.h"
#include "experiment/race.h"
#include "results/race_row.h"
#include "trace/folder.h"

namespace regather::experiment {

struct TraceRace {
    Orderings
        orderings;  ///< Naive, which the others are compared with, runs whether it is among them or not.
    std::vector<Structure> structures;
    std::uint32_t k = 0;        ///< Photons of a search; 0: as captured.
    std::uint64_t queries = 0;  ///< So many, from the middle of the capture; 0: all.
    std::uint32_t repeats = 11, threads = 1;
    bool gathered = false;  ///< As in RaceConfig.
};

/// Ordering by ordering, structure by structure. The greatest radius of a search is the trace's. Throws
/// trace::UsageError for more queries than there are, trace::DataError for a trace whose photons are in no
/// order of a kd-tree, that has no queries, or whose searches find other than it says.
std::vector<results::RaceRow> race(trace::TraceReader& trace, TraceRace asked,
                                   const ProgressListener& progress);

}  // namespace regather::experiment
