// results/table.h -- traffic by ordering for a terminal: at most 120 characters wide (100 without the columns
// that only some rows have), one block for each scene, structure and cache. The ratios stand here and not in
// the CSV, which holds counts only.
#pragma once
#include <span>
#include <string>

#include "results/row.h"

namespace regather::results {

/// Rows in the order given. "of naive" compares with the block's row "naive" and is empty without one; "x
/// floor" is traffic over compulsory traffic. Rows without traffic show their costs only. The classes of
/// misses ("3C"), the uncertainty of sampled rows ("+-") and the net traffic have a column where a row of the
/// block has them.
std::string table(std::span<const Row> rows);

}  // namespace regather::results
