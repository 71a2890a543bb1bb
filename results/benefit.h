// results/benefit.h -- what an ordering saves net of what it costs: the buffers of a deferred ordering that
// do not fit the chip go through memory, too, so the traffic of the photons alone flatters it (section 5 of
// the paper).
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "results/row.h"

namespace regather::results {

/// Traffic of the reorder buffers: as simulated, else as the ordering's cost tells it (reorder_bytes).
/// Nothing when the row has neither.
std::optional<std::uint64_t> buffer_traffic(const Row& row);

/// Traffic of the photons and of the reorder buffers. Nothing when one of them is missing.
std::optional<std::uint64_t> net_traffic(const Row& row);

/// Fills net_benefit_bytes: the traffic of the row "naive" with the same scene, frame, structure, layout,
/// policy, cache, on-chip bytes and set sampling, less the row's net traffic. It is negative when reordering
/// costs more than it saves, and empty without a naive row. Throws trace::DataError when two naive rows
/// contradict each other.
void fill_net_benefit(std::span<Row> rows);

}  // namespace regather::results
