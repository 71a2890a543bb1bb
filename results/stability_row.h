// results/stability_row.h -- one case of the stability table: what a stiff or extreme input did to one
// number, beside what it may do and why.
#pragma once
#include <span>
#include <string>

#include "results/column.h"
#include "results/table.h"

namespace regather::results {

struct StabilityRow {
    static const RowKind& kind();

    std::string group, stability_case;
    std::string quantity;  ///< What `error` is of: "relative error of the radiance".
    Number error, allowed_error;
    Flag passed;         ///< Written as 1 or 0; a NaN or infinite error is an empty cell and not passed.
    Number seconds;      ///< Of the case.
    std::string reason;  ///< Why that much is allowed.
};

/// A line a row, those that failed with "FAILED"; below, how many passed.
Table stability_table(std::span<const StabilityRow> rows);

}  // namespace regather::results
