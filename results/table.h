// results/table.h -- a table for people: a title, a header, lines of cells, notes. It knows no rows; the
// renderers below know nothing else.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "results/column.h"

namespace regather::results {

enum class Align { left, right };

class Table {
public:
    struct Limits {
        bool if_any = false;   ///< The column is left away when all its cells are empty.
        std::size_t most = 0;  ///< Longer cells are cut to so many letters; 0: they are not.
    };
    struct Head {
        std::string name;
        Align align = Align::right;
        Limits limits = {};
    };

    explicit Table(std::vector<Head> heads) : heads_(std::move(heads)) {}

    /// A cell for each head.
    void add(std::vector<std::string> cells);

    std::string title;               ///< Above; empty: none.
    std::vector<std::string> notes;  ///< Below, a line each.

    const std::vector<Head>& heads() const { return heads_; }
    const std::vector<std::vector<std::string>>& lines() const { return lines_; }
    bool empty() const { return lines_.empty(); }
    /// By head: false for one with if_any and no cell that says something.
    std::vector<bool> shown() const;

private:
    std::vector<Head> heads_;
    std::vector<std::vector<std::string>> lines_;
};

/// For a terminal: columns two blanks apart, no blanks at the end of a line. `widest`: letters a line; the
/// first column is cut for it, to 12 letters at the least; 0: as wide as it gets.
std::string text_of(const Table& table, std::size_t widest = 0);
/// Several, with an empty line between them.
std::string text_of(std::span<const Table> tables, std::size_t widest = 0);

/// All columns of rows that say something, as the CSV has them.
Table table_of(const RowKind& kind, std::size_t count,
               const void* (*row)(const void* rows, std::size_t place), const void* rows);
template <class R>
Table table_of(std::span<const R> rows) {
    return table_of(
        R::kind(), rows.size(),
        [](const void* first, std::size_t place) -> const void* {
            return static_cast<const R*>(first) + place;
        },
        rows.data());
}

/// Letters of a UTF-8 text.
std::size_t letters(std::string_view utf8);
/// Cut to `most` letters, the last three "...".
std::string cut(std::string_view utf8, std::size_t most);

/// As a cell of a CSV: in quotes where it must be.
std::string csv_cell(std::string_view text);

}  // namespace regather::results
