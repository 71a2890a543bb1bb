// experiment/address_sweep.h -- an address trace of anybody's, read once, through many caches or memory
// systems: rows.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cachesim/address_trace.h"
#include "cachesim/machines/machine.h"
#include "cachesim/policies/policy_sweep.h"
#include "experiment/progress.h"
#include "results/cache_row.h"
#include "results/machine_row.h"

namespace regather::experiment {

/// Each may be empty.
struct SweepListeners {
    ProgressListener progress;
    NoteListener note;  ///< What the trace's reader passed over, a line each.
};

/// Lists, separated by commas, that are multiplied out, and what all caches have in common.
struct CacheLists {
    std::string sizes, lines, ways, policies = "lru";
    std::string write = "back", write_miss = "allocate", index = "modulo";
    std::uint64_t seed = 0;  ///< Of the policy random.
};

struct Combinations {
    std::vector<cachesim::PolicyConfig> caches;
    std::vector<std::string> left_out;  ///< Those that are not possible, a line each, with the reason.
};

/// Every combination, sizes outermost, policies innermost. Throws trace::UsageError for one that is there
/// twice, and when none is possible.
Combinations combinations(const CacheLists& lists);

/// A row for each cache, in their order.
std::vector<results::CacheRow> sweep_policies(const cachesim::AddressFiles& files,
                                              std::span<const cachesim::PolicyConfig> configs,
                                              const cachesim::PolicySweepOptions& options,
                                              const SweepListeners& listeners);

/// Every LRU cache of the line sizes, of up to `most_ways` ways (1 to 32) and fully associative; with the
/// classes of misses, if asked for. What a trace with writes writes back is not told.
std::vector<results::CacheRow> sweep_all_lru(const cachesim::AddressFiles& files,
                                             std::span<const std::uint32_t> line_sizes,
                                             std::uint32_t most_ways, bool classes,
                                             const SweepListeners& listeners);

/// "gpu-a100,my/machine.json": each an embedded machine's name or a file. Throws trace::UsageError for one
/// that is there twice.
std::vector<cachesim::Machine> load_machines(std::string_view list);

/// One row for each region that did anything and each level, and for the DRAM if there is one. A column that
/// does not apply to a row is empty. docs/machines.md has the columns. `counts` are of the machine's
/// hierarchy.
std::vector<results::MachineRow> machine_rows(const cachesim::Machine& machine,
                                              const cachesim::HierarchyCounts& counts);

/// The trace, read once, through each machine from empty to flushed. All is charged to Region::other.
std::vector<results::MachineRow> sweep_machines(std::span<const cachesim::Machine> machines,
                                                const cachesim::AddressFiles& files,
                                                const SweepListeners& listeners);

}  // namespace regather::experiment
