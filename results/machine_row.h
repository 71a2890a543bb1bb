// results/machine_row.h -- one level of a machine, or its DRAM, and one region of data: docs/machines.md.
#pragma once
#include <string>

#include "results/column.h"

namespace regather::results {

struct MachineRow {
    static const RowKind& kind();

    std::string scene, structure, layout, ordering, parameters;  ///< As in Row; empty for an address trace.
    std::string machine, level;                                  ///< "gpu-a100"; "L1", "dram"
    std::string region;                                          ///< "photons", "other"
    Count accesses, hits, misses, sector_misses, victim_hits, writebacks, clean_victims, writes_through,
        back_invalidations, prefetches, useful_prefetches, bytes_in, bytes_out;  ///< Of a level.
    Count bursts_read, bursts_written, row_hits, row_empty, row_conflicts;       ///< Of DRAM.
    Number picojoules;                                                           ///< Of DRAM.
};

}  // namespace regather::results
