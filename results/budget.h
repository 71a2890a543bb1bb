// results/budget.h -- what can be reached with so much state on the chip: the least net traffic over all
// orderings and their parameters, for each cache. State is what an ordering keeps beside the cache: pixels,
// buckets, queries that wait to be sorted (the paper, section 6.3).
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "results/geometry.h"
#include "results/row.h"
#include "results/table.h"

namespace regather::results {

/// Whether the ordering's buffers fit into onchip_bytes; without onchip_bytes, whether nothing of them goes
/// off the chip.
bool stays_on_chip(const Row& row);

/// [bytes] Of the ordering: all that it buffers where it stays on the chip; else all of onchip_bytes, in
/// which what comes back from memory is sorted. Nothing when a row does not say.
std::optional<std::uint64_t> onchip_state(const Row& row);

enum class Buffers : std::uint8_t {
    on_chip,   ///< Orderings whose buffers stay on the chip.
    anywhere,  ///< And those whose buffers go through memory, which is part of their net traffic.
};

/// From this state on, until the next step, a row has the least net traffic.
struct FrontStep {
    std::uint64_t state_bytes = 0, net_bytes = 0;
    const Row* row = nullptr;
};

/// Of one cache: state rises, net traffic falls, both strictly.
struct Front {
    std::uint64_t cache_bytes = 0;
    std::vector<FrontStep> steps;
    const FrontStep* within(std::uint64_t state_bytes) const;  ///< The best; null when none needs so little.
};

/// Those of the rows that tell net traffic and have the line size and ways of `cache`, whatever their size;
/// without one, of the commonest_geometry() of such rows.
std::vector<Row> rows_of_shape(std::span<const Row> rows, std::optional<Geometry> cache);
/// Whether all are of one scene, frame, structure, layout and policy.
bool of_one_setting(std::span<const Row> rows);

/// By rising cache size. Of equals the first row. Rows must outlive the fronts.
std::vector<Front> fronts(std::span<const Row> rows, Buffers buffers);

/// The state that the tables ask for: 1 KiB to 64 MiB in steps of four.
std::vector<std::uint64_t> budgets();

/// For each cache who wins within each of the budgets, with and without buffers through memory; a line that
/// says what the one before says is left away. Rows of one shape and setting.
std::vector<Table> budget_tables(std::span<const Row> rows);

/// The rows on the fronts of both kinds, each once, in their order among `rows`.
std::vector<Row> front_rows(std::span<const Row> rows);

}  // namespace regather::results
