// experiment/replays.h -- every ordering of a trace's queries through caches, or through memory systems:
// rows.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "cachesim/machines/machine.h"
#include "experiment/measurement.h"
#include "experiment/progress.h"
#include "results/machine_row.h"
#include "results/row.h"

namespace regather::experiment {

/// Layout by layout, ordering by ordering, cache by cache, with the compulsory traffic and, where naive is
/// among them, the net benefit. `layouts` are specs (replay/layouts/catalogue.h). Throws trace::UsageError as
/// replay::make_layout(), and for a layout that is there twice.
std::vector<results::Row> through_caches(Measurement& measurement, std::span<const std::string> layouts,
                                         std::span<const reorder::ParsedOrdering> orderings,
                                         std::span<const cachesim::CacheConfig> caches, const Method& method,
                                         const ProgressListener& progress);

/// Layout by layout, ordering by ordering, machine by machine; layouts and errors as through_caches().
std::vector<results::MachineRow> through_machines(Measurement& measurement,
                                                  std::span<const std::string> layouts,
                                                  std::span<const reorder::ParsedOrdering> orderings,
                                                  std::span<const cachesim::Machine> machines,
                                                  const ProgressListener& progress);

}  // namespace regather::experiment
