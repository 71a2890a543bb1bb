// cli/machine.h -- memory systems from machine files: address traces through them, and what came out as rows.
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "cachesim/address_trace.h"
#include "cachesim/machine.h"
#include "cli/progress.h"
#include "results/machine_row.h"

namespace regather::cli {

/// "gpu-a100,my/machine.json": each an embedded machine's name or a file.
std::vector<cachesim::Machine> load_machines(std::string_view list);

/// One for each region that did anything and each level, and for the DRAM if there is one; what was replayed
/// is left open.
std::vector<results::MachineRow> machine_rows(const cachesim::Machine& machine,
                                              const cachesim::Hierarchy& hierarchy);

/// The trace, read once, through each machine from empty to flushed. All is charged to Region::other; what
/// the trace's reader passed over is said on `progress`.
std::vector<results::MachineRow> run_machines(std::span<const cachesim::Machine> machines,
                                              const cachesim::AddressFiles& files, Progress& progress);

}  // namespace regather::cli
