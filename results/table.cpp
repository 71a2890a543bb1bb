#include "results/table.h"

#include <algorithm>
#include <iterator>

#include "results/csv.h"
#include "trace/text.h"

namespace regather::results {
namespace {

constexpr std::size_t gap = 2, narrowest = 12;

bool continues(char c) {
    return (static_cast<unsigned char>(c) >> 6) == 2;
}

std::string padded(const std::string& text, std::size_t width, Align align) {
    const std::size_t blanks = width - std::min(width, letters(text));
    return align == Align::left ? text + std::string(blanks, ' ') : std::string(blanks, ' ') + text;
}

/// Of each column in letters; 0: not shown.
std::vector<std::size_t> widths_of(const Table& table, std::size_t widest) {
    const std::vector<bool> shown = table.shown();
    std::vector<std::size_t> widths(shown.size());
    std::size_t others = 0;
    for (std::size_t c = 0; c < widths.size(); ++c) {
        if (!shown[c]) continue;
        const Table::Head& head = table.heads()[c];
        widths[c] = letters(head.name);
        for (const auto& line : table.lines()) widths[c] = std::max(widths[c], letters(line[c]));
        if (head.limits.most > 0) widths[c] = std::min(widths[c], head.limits.most);
        if (c > 0) others += gap + widths[c];
    }
    if (widest > 0 && !widths.empty())
        widths[0] = std::min(widths[0], std::max(narrowest, widest - std::min(others, widest)));
    return widths;
}

std::string line_of(const Table& table, const std::vector<std::string>& cells,
                    std::span<const std::size_t> widths) {
    std::string out;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (widths[c] == 0) continue;
        if (!out.empty()) out += std::string(gap, ' ');
        out += padded(cut(cells[c], widths[c]), widths[c], table.heads()[c].align);
    }
    return out.substr(0, out.find_last_not_of(' ') + 1) + '\n';
}

std::vector<std::string> names_of(const Table& table) {
    std::vector<std::string> names;
    for (const Table::Head& head : table.heads()) names.push_back(head.name);
    return names;
}

/// As a terminal may show it: foreign text stands in cells, titles and notes.
Table on_lines(const Table& table) {
    constexpr std::size_t most_cell = 200, most_line = 1000;  // [bytes]
    Table out(table.heads());
    out.title = trace::shown(table.title, most_line);
    for (std::vector<std::string> cells : table.lines()) {
        for (std::string& cell : cells) cell = trace::shown(cell, most_cell);
        out.add(std::move(cells));
    }
    for (const std::string& note : table.notes) out.notes.push_back(trace::shown(note, most_line));
    return out;
}

}  // namespace

void Table::add(std::vector<std::string> cells) {
    cells.resize(heads_.size());
    lines_.push_back(std::move(cells));
}

std::vector<bool> Table::shown() const {
    std::vector<bool> out;
    for (std::size_t c = 0; c < heads_.size(); ++c)
        out.push_back(
            !heads_[c].limits.if_any ||
            std::any_of(lines_.begin(), lines_.end(), [&](const auto& line) { return !line[c].empty(); }));
    return out;
}

std::string text_of(const Table& of, std::size_t widest) {
    const Table table = on_lines(of);
    const std::vector<std::size_t> widths = widths_of(table, widest);
    std::string out = table.title.empty() ? "" : table.title + '\n';
    out += line_of(table, names_of(table), widths);
    for (const auto& line : table.lines()) out += line_of(table, line, widths);
    for (const std::string& note : table.notes) out += note + '\n';
    return out;
}

std::string text_of(std::span<const Table> tables, std::size_t widest) {
    std::string out;
    for (const Table& table : tables) out += (out.empty() ? "" : "\n") + text_of(table, widest);
    return out;
}

Table table_of(const RowKind& kind, std::size_t count, const void* (*row)(const void*, std::size_t),
               const void* rows) {
    std::vector<Table::Head> heads;
    for (const Column& column : kind.columns) {
        const bool is_text = column.form == Form::text || column.form == Form::name;
        heads.push_back({std::string(column.name), is_text ? Align::left : Align::right, {.if_any = true}});
    }
    Table out(std::move(heads));
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<std::string> cells;
        for (const Column& column : kind.columns) cells.push_back(cell_text(column, row(rows, i)));
        out.add(std::move(cells));
    }
    return out;
}

std::size_t letters(std::string_view utf8) {
    return static_cast<std::size_t>(
        std::count_if(utf8.begin(), utf8.end(), [](char c) { return !continues(c); }));
}

std::string cut(std::string_view utf8, std::size_t most) {
    if (letters(utf8) <= most) return std::string(utf8);
    const std::size_t kept = most - std::min<std::size_t>(most, 3);
    std::size_t end = 0;
    for (std::size_t seen = 0; end < utf8.size(); ++end)
        if (!continues(utf8[end]) && seen++ == kept) break;
    return std::string(utf8.substr(0, end)) + std::string(std::min<std::size_t>(most, 3), '.');
}

std::string csv_cell(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == text.npos) return std::string(text);
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + '"';
}

}  // namespace regather::results
