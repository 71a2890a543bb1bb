// results/rows.h -- every kind of rows there is, and rows of any of them together.
#pragma once
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "results/cache_row.h"
#include "results/computation_row.h"
#include "results/convergence_row.h"
#include "results/csv.h"
#include "results/detail_row.h"
#include "results/frame_row.h"
#include "results/machine_row.h"
#include "results/race_row.h"
#include "results/row.h"
#include "results/sampling_row.h"
#include "results/stability_row.h"
#include "results/timeline_row.h"

namespace regather::results {

/// The kinds that a file may hold, in the order in which its header is held against them: the columns that
/// one needs are not all among those of a later one.
template <template <class...> class List>
using EachKind = List<ConvergenceRow, StabilityRow, ComputationRow, RaceRow, FrameRow, MachineRow,
                      SamplingRow, TimelineRow, DetailRow, CacheRow, Row>;

/// The first kind whose needed columns are all in the header; where there is none, the one with most of the
/// columns (of equals the last), which then refuses the file. Throws trace::DataError for a text without a
/// header.
const RowKind& row_kind(std::string_view text, std::string_view file);

class Rows {
public:
    Rows() = default;
    template <class R>
    explicit Rows(std::vector<R> rows) {
        of<R>() = std::move(rows);
    }

    template <class R>
    std::vector<R>& of() {
        return std::get<std::vector<R>>(tables_);
    }
    template <class R>
    const std::vector<R>& of() const {
        return std::get<std::vector<R>>(tables_);
    }

    /// Adds those of a CSV, of the kind that its header tells. The names of the columns that no kind of rows
    /// has are given back. Throws as from_csv().
    std::vector<std::string> add(std::string_view text, std::string_view file);

private:
    template <class... R>
    using Vectors = std::tuple<std::vector<R>...>;
    EachKind<Vectors> tables_;
};

}  // namespace regather::results
