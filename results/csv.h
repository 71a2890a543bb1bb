// results/csv.h -- measurements as comma-separated values: RFC 4180 quoting, UTF-8, LF line ends, header
// first. A cell that does not apply is empty; a fully associative cache has "full" ways; seconds have six
// digits. Counts only, with the unit in the column's name: ratios belong to tables and charts. Columns:
// docs/charts.md.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "results/row.h"

namespace regather::results {

using Seconds = std::optional<double>;
/// A count whose 0 is written as "full".
struct Ways {
    Count Row::*field;
};

/// A column is a field of Row under a name; the same table writes and reads.
struct Column {
    std::string_view name;
    std::variant<std::string Row::*, Count Row::*, Seconds Row::*, Ways> field;
    bool needed = false;  ///< A file without it is refused.
};
std::span<const Column> columns();  ///< In the order in which they are written.

std::string to_csv(std::span<const Row> rows);

/// Rows that anybody wrote: columns in any order, foreign ones ignored, absent ones left empty, CRLF
/// accepted. Throws trace::DataError (file, line, column, found, expected) for a missing needed column, a
/// column named twice, a ragged row, broken quotes and a cell that is no number. `file` is for the message
/// only.
std::vector<Row> from_csv(std::string_view text, std::string_view file);

void write_csv(const std::filesystem::path& path, std::span<const Row> rows);
std::vector<Row> read_csv(const std::filesystem::path& path);

}  // namespace regather::results
