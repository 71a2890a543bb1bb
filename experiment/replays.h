// experiment/replays.h -- every ordering of a trace's queries through caches, or through memory systems:
// rows.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "cachesim/machines/machine.h"
#include "experiment/measurement.h"
#include "experiment/progress.h"
#include "replay/treelet_queues.h"
#include "results/machine_row.h"
#include "results/row.h"

namespace regather::experiment {

/// What a trace is put through.
struct Replays {
    std::span<const std::string> layouts;  ///< Specs (replay/layouts/catalogue.h); none: the measurement's.
    std::span<const reorder::ParsedOrdering> orderings;
    /// Each ordering also feeds these, in rows of their own.
    std::span<const replay::TreeletConfig> treelets;
};

/// Layout by layout, ordering by ordering, cache by cache, with the compulsory traffic and, where naive is
/// among them, the net benefit; behind the rows of an ordering those of its treelet queues. Throws
/// trace::UsageError as replay::make_layout() and replay::hierarchy_of(), and for a layout that is there
/// twice.
std::vector<results::Row> through_caches(Measurement& measurement, const Replays& replays,
                                         std::span<const cachesim::CacheConfig> caches, const Method& method,
                                         const ProgressListener& progress);

/// Layout by layout, ordering by ordering, machine by machine; the rest and errors as through_caches().
std::vector<results::MachineRow> through_machines(Measurement& measurement, const Replays& replays,
                                                  std::span<const cachesim::Machine> machines,
                                                  const ProgressListener& progress);

}  // namespace regather::experiment
