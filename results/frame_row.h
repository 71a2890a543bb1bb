// results/frame_row.h -- one trace's share of a frame at one level of a machine, together with the other
// traces or apart: docs/rays.md.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "results/machine_row.h"
#include "results/table.h"

namespace regather::results {

/// A row of a machine, and whose it is.
struct FrameRow : MachineRow {
    static const RowKind& kind();

    Count frame;
    std::string unit;  ///< In which steps the parts took turns: "pixel", "tile=16", "frame".
    std::string run;   ///< "together": all parts through one hierarchy; "apart": each through one of its own.
    std::string part;  ///< "gather rays", "photons"
    Count queries;     ///< Of the part.
};

inline constexpr std::string_view together = "together", apart = "apart";

/// Bytes that each part moves between a level and what lies below it, apart and together, and the difference;
/// then their sums. A line a unit, machine, level (but not DRAM) and part, in the order of the rows.
Table frame_table(std::span<const FrameRow> rows);

}  // namespace regather::results
