// results/csv.h -- rows as comma-separated values: RFC 4180 quoting, UTF-8, LF line ends, header first. A
// cell that does not apply is empty; a fully associative cache has "full" ways; seconds have six digits.
// Counts only, with the unit in the column's name: ratios belong to tables and charts. Columns:
// docs/charts.md.
#pragma once
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "results/row.h"

namespace regather::results {

/// What the CSV says of one column of a row, without quotes.
std::string cell_text(const Column& column, const void* row);

/// `count` rows that begin at `first`, `bytes` apart.
std::string to_csv(const RowKind& kind, const void* first, std::size_t count, std::size_t bytes);

/// Rows that anybody wrote: columns in any order, absent ones left empty, CRLF accepted. `next` gives an
/// empty row to fill. A column that nobody knows is refused when its name is close to one that is absent
/// ("traffic_byte"), else left out and told in `unknown`. Throws trace::DataError (file, line, column, found,
/// expected) for that, a missing needed column, a column named twice, a ragged row, broken quotes and a cell
/// that its column does not take. `file` is for the message only.
void from_csv(const RowKind& kind, std::string_view text, std::string_view file,
              const std::function<void*()>& next, std::vector<std::string>* unknown = nullptr);

/// The names in the header line. Throws trace::DataError for a text without one.
std::vector<std::string> header_of(std::string_view text, std::string_view file);

/// Rows into a file, whole or not at all.
void write_csv(const std::filesystem::path& path, std::string_view csv);
/// The text of a file of rows.
std::string read_csv_text(const std::filesystem::path& path);

// By the type of row, which has its kind(); without it, measurements:

template <class R = Row>
std::string to_csv(std::type_identity_t<std::span<const R>> rows) {
    return to_csv(R::kind(), rows.data(), rows.size(), sizeof(R));
}
template <class R = Row>
std::vector<R> from_csv(std::string_view text, std::string_view file) {
    std::vector<R> rows;
    from_csv(R::kind(), text, file, [&]() -> void* { return &rows.emplace_back(); });
    return rows;
}
template <class R = Row>
void write_csv(const std::filesystem::path& path, std::type_identity_t<std::span<const R>> rows) {
    write_csv(path, std::string_view(to_csv<R>(rows)));
}
template <class R = Row>
std::vector<R> read_csv(const std::filesystem::path& path) {
    return from_csv<R>(read_csv_text(path), path.string());
}

}  // namespace regather::results
