// cli/machine.h -- memory systems from machine files: address traces through them, and what came out as CSV.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cachesim/address_trace.h"
#include "cachesim/machine.h"
#include "cli/progress.h"

namespace regather::cli {

/// "gpu-a100,my/machine.json": each an embedded machine's name or a file.
std::vector<cachesim::Machine> load_machines(std::string_view list);

/// The first line of machine_rows(), with its end.
std::string machine_header();
/// One row for each region that did anything and each level, and for the DRAM if there is one. Counts only; a
/// column that does not apply to a row is empty. docs/machines.md has the columns.
std::string machine_rows(const cachesim::Machine& machine, const cachesim::Hierarchy& hierarchy);

/// A whole CSV: the trace, read once, through each machine from empty to flushed. All is charged to
/// Region::other; what the trace's reader passed over is said on `progress`.
std::string run_machines(std::span<const cachesim::Machine> machines, const cachesim::AddressFiles& files,
                         Progress& progress);

}  // namespace regather::cli
