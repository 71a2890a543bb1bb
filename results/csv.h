// results/csv.h -- rows as comma-separated values: RFC 4180 quoting, UTF-8, LF line ends, header first. A
// cell that does not apply is empty; a fully associative cache has "full" ways; seconds have six digits.
// Counts only, with the unit in the column's name: ratios belong to tables and charts. Columns:
// docs/charts.md.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "results/convergence_row.h"
#include "results/detail_row.h"
#include "results/row.h"
#include "results/sampling_row.h"
#include "results/stability_row.h"
#include "results/timeline_row.h"

namespace regather::results {

using Signed = std::optional<std::int64_t>;
using Flag = std::optional<bool>;  ///< Written as 1 or 0.

/// A count whose 0 is written as "full".
template <class R>
struct Ways {
    Count R::*field;
};
/// From 0 up, with six digits after the point.
template <class R>
struct Seconds {
    std::optional<double> R::*field;
};
/// From 0 up, with as many digits as give the same number back.
template <class R>
struct Real {
    std::optional<double> R::*field;
};

/// As Real, and below 0 too.
template <class R>
struct SignedReal {
    std::optional<double> R::*field;
};

/// A column is a field of a row under a name; the same table writes and reads.
template <class R>
struct Column {
    std::string_view name;
    std::variant<std::string R::*, Count R::*, Signed R::*, Flag R::*, Ways<R>, Seconds<R>, Real<R>,
                 SignedReal<R>>
        field;
    bool needed = false;  ///< A file without it is refused.
};

/// In the order in which they are written. R is a kind of row, here and below: Row, DetailRow, TimelineRow,
/// SamplingRow, ConvergenceRow, LadderRow, StabilityRow.
template <class R>
std::span<const Column<R>> columns();

template <class R = Row>
std::string to_csv(std::type_identity_t<std::span<const R>> rows);

/// Rows that anybody wrote: columns in any order, foreign ones ignored, absent ones left empty, CRLF
/// accepted. Throws trace::DataError (file, line, column, found, expected) for a missing needed column, a
/// column named twice, a ragged row, broken quotes and a cell that is no number. `file` is for the message
/// only.
template <class R = Row>
std::vector<R> from_csv(std::string_view text, std::string_view file);

template <class R = Row>
void write_csv(const std::filesystem::path& path, std::type_identity_t<std::span<const R>> rows);
template <class R = Row>
std::vector<R> read_csv(const std::filesystem::path& path);

enum class RowKind { measurement, detail, timeline, sampling, convergence, stability };

/// By the header line: the kind whose needed columns are all there, else measurement. Throws trace::DataError
/// for a text without a header.
RowKind row_kind(std::string_view text, std::string_view file);

}  // namespace regather::results
