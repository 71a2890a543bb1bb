// results/machine_columns.h -- the columns that all kinds of rows about a level of a machine end with.
#pragma once
#include <array>
#include <cstddef>

#include "results/column.h"
#include "results/machine_row.h"

namespace regather::results {

/// What a level or its memory counted, for rows of kind R: MachineRow, or what has it as a base.
template <class R>
constexpr std::array machine_counts{
    column<&MachineRow::accesses, R>("accesses"),
    column<&MachineRow::hits, R>("hits"),
    column<&MachineRow::misses, R>("misses"),
    column<&MachineRow::sector_misses, R>("sector_misses"),
    column<&MachineRow::victim_hits, R>("victim_hits"),
    column<&MachineRow::writebacks, R>("writebacks"),
    column<&MachineRow::clean_victims, R>("clean_victims"),
    column<&MachineRow::writes_through, R>("writes_through"),
    column<&MachineRow::back_invalidations, R>("back_invalidations"),
    column<&MachineRow::prefetches, R>("prefetches"),
    column<&MachineRow::useful_prefetches, R>("useful_prefetches"),
    column<&MachineRow::bytes_in, R>("bytes_in"),
    column<&MachineRow::bytes_out, R>("bytes_out"),
    column<&MachineRow::bursts_read, R>("bursts_read"),
    column<&MachineRow::bursts_written, R>("bursts_written"),
    column<&MachineRow::row_hits, R>("row_hits"),
    column<&MachineRow::row_empty, R>("row_empty"),
    column<&MachineRow::row_conflicts, R>("row_conflicts"),
    column<&MachineRow::picojoules, R>("picojoules"),
};

/// Columns, and behind them those of machine_counts.
template <class R, std::size_t size>
constexpr auto with_machine_counts(const std::array<Column, size>& columns) {
    std::array<Column, size + machine_counts<R>.size()> all{};
    for (std::size_t c = 0; c < size; ++c) all[c] = columns[c];
    for (std::size_t c = 0; c < machine_counts<R>.size(); ++c) all[size + c] = machine_counts<R>[c];
    return all;
}

}  // namespace regather::results
