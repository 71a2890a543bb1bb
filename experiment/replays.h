// experiment/replays.h -- every ordering of a trace's queries through caches, or through memory systems:
// rows.
#pragma once
#include <span>
#include <vector>

#include "cachesim/machines/machine.h"
#include "experiment/measurement.h"
#include "experiment/progress.h"
#include "results/machine_row.h"
#include "results/row.h"

namespace regather::experiment {

/// Ordering by ordering, cache by cache, with the compulsory traffic and, where naive is among them, the net
/// benefit.
std::vector<results::Row> through_caches(Measurement& measurement,
                                         std::span<const reorder::ParsedOrdering> orderings,
                                         std::span<const cachesim::CacheConfig> caches, const Method& method,
                                         const ProgressListener& progress);

/// Ordering by ordering, machine by machine; `scene` is the trace's.
std::vector<results::MachineRow> through_machines(const Measurement& measurement,
                                                  std::span<const reorder::ParsedOrdering> orderings,
                                                  std::span<const cachesim::Machine> machines,
                                                  const std::string& scene, const ProgressListener& progress);

}  // namespace regather::experiment
