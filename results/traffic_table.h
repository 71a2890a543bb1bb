// results/traffic_table.h -- traffic by ordering: one table for each scene, structure and cache. The ratios
// stand here and not in the CSV, which holds counts only.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "results/row.h"
#include "results/table.h"

namespace regather::results {

/// Rows in the order given. "of naive" compares with the block's row "naive" and is empty without one; "x
/// floor" is traffic over compulsory traffic. Rows without traffic show their costs only. The classes of
/// misses ("3C"), the uncertainty of sampled rows ("+-") and the net traffic have a column where a row of the
/// block has them.
std::vector<Table> traffic_tables(std::span<const Row> rows);
/// For a terminal: at most 120 letters wide.
std::string traffic_text(std::span<const Row> rows);

}  // namespace regather::results
