// results/stability_row.h -- one case of the stability table: what a stiff or extreme input did to one
// number, beside what it may do and why.
#pragma once
#include <optional>
#include <string>

#include "results/row.h"

namespace regather::results {

struct StabilityRow {
    std::string group, stability_case;
    std::string quantity;  ///< What `error` is of: "relative error of the radiance".
    std::optional<double> error, allowed_error;
    std::optional<bool>
        passed;  ///< Written as 1 or 0; a NaN or infinite error is an empty cell and not passed.
    std::optional<double> seconds;  ///< Of the case.
    std::string reason;             ///< Why that much is allowed.
};

}  // namespace regather::results
