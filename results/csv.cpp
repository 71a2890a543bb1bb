#include "results/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include "trace/error.h"
#include "trace/file.h"

namespace regather::results {
namespace {

constexpr bool needed = true;
constexpr Column table[] = {
    {"scene", &Row::scene},
    {"frame", &Row::frame},
    {"ordering", &Row::ordering, needed},
    {"tile", &Row::tile},
    {"bins", &Row::bins},
    {"structure", &Row::structure},
    {"layout", &Row::layout},
    {"policy", &Row::policy},
    {"cache_bytes", &Row::cache_bytes, needed},
    {"line_bytes", &Row::line_bytes, needed},
    {"ways", Ways{&Row::ways}, needed},
    {"queries", &Row::queries},
    {"accesses", &Row::accesses},
    {"raw_bytes", &Row::raw_bytes},
    {"oracle_bytes", &Row::oracle_bytes},
    {"compulsory_bytes", &Row::compulsory_bytes},
    {"misses", &Row::misses},
    {"traffic_bytes", &Row::traffic_bytes, needed},
    {"reorder_bytes", &Row::reorder_bytes},
    {"key_ops", &Row::key_ops},
    {"moved_records", &Row::moved_records},
    {"buffered_bytes", &Row::buffered_bytes},
    {"recast_rays", &Row::recast_rays},
    {"order_seconds", &Row::order_seconds},
    {"replay_seconds", &Row::replay_seconds},
    {"parameters", &Row::parameters},
    {"keys", &Row::keys},
    {"sort_passes", &Row::sort_passes},
    {"stalls", &Row::stalls},
};

std::string text_cell(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == text.npos) return std::string(text);
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + '"';
}

struct CellWriter {
    const Row& row;
    std::string operator()(std::string Row::*field) const { return text_cell(row.*field); }
    std::string operator()(Count Row::*field) const {
        return row.*field ? fmt::to_string(*(row.*field)) : "";
    }
    std::string operator()(Seconds Row::*field) const {
        return row.*field ? fmt::format("{:.6f}", *(row.*field)) : "";
    }
    std::string operator()(Ways ways) const {
        return row.*ways.field == std::uint64_t{0} ? "full" : (*this)(ways.field);
    }
};

/// What was found, fit for one line of a message.
std::string shown(std::string_view text) {
    std::string out;
    for (const char c : text.substr(0, 40)) out += static_cast<unsigned char>(c) < ' ' ? '?' : c;
    return text.size() > 40 ? out + "..." : out;
}

/// Cuts the text into records of cells; remembers lines for messages.
class Records {
public:
    Records(std::string_view text, std::string_view file) : text_(text), file_(file) {
        if (text_.substr(0, 3) == "\xEF\xBB\xBF") text_.remove_prefix(3);  // byte order mark of spreadsheets
    }

    /// False at the end. Empty lines are skipped. line() is that of the record's start.
    bool next(std::vector<std::string>& cells) {
        while (at_ < text_.size() && end_of_line()) step();
        if (at_ >= text_.size()) return false;
        line_ = reading_;
        cells.clear();
        for (;;) {
            const bool quote = at_ < text_.size() && text_[at_] == '"';
            cells.push_back(quote ? quoted_cell(cells.size()) : plain_cell(cells.size()));
            if (at_ >= text_.size()) return true;
            if (end_of_line()) {
                step();
                return true;
            }
            ++at_;  // the comma
        }
    }

    std::size_t line() const { return line_; }

    [[noreturn]] void refuse(std::size_t line, std::size_t cell, std::string_view name,
                             std::string_view found, std::string_view expected) const {
        throw trace::DataError(fmt::format("{}: line {}, column {}{}: found {}, expected {}", file_, line,
                                           cell + 1, name.empty() ? "" : fmt::format(" ({})", shown(name)),
                                           found, expected));
    }

private:
    bool end_of_line() const {
        return text_[at_] == '\n' || (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n');
    }
    void step() {  // over the end of a line
        at_ += text_[at_] == '\r' ? 2 : 1;
        ++reading_;
    }
    std::string plain_cell(std::size_t cell) {
        const std::size_t start = at_;
        while (at_ < text_.size() && text_[at_] != ',' && !end_of_line()) {
            if (text_[at_] == '"')
                refuse(reading_, cell, "", "a quote inside a cell", "quotes around the whole cell");
            ++at_;
        }
        return std::string(text_.substr(start, at_ - start));
    }
    std::string quoted_cell(std::size_t cell) {
        const std::size_t opened = reading_;
        std::string out;
        for (++at_; at_ < text_.size(); ++at_) {
            if (text_[at_] == '"') {
                if (at_ + 1 >= text_.size() || text_[at_ + 1] != '"') {
                    ++at_;
                    if (at_ < text_.size() && text_[at_] != ',' && !end_of_line())
                        refuse(reading_, cell, "", "text after a closing quote",
                               "a comma or the end of the line");
                    return out;
                }
                ++at_;
            } else if (text_[at_] == '\n') {
                ++reading_;
            }
            out += text_[at_];
        }
        refuse(opened, cell, "", "a quote that is never closed", "a closing quote");
    }

    std::string_view text_, file_;
    std::size_t at_ = 0, reading_ = 1, line_ = 1;
};

struct CellReader {
    Row& row;
    const std::string& text;
    /// Null, or what was expected.
    const char* operator()(std::string Row::*field) const {
        row.*field = text;
        return nullptr;
    }
    const char* operator()(Count Row::*field) const {
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error == std::errc::result_out_of_range) return "a whole number below 2^64";
        if (error != std::errc{} || end != text.data() + text.size())
            return "a whole number or an empty cell";
        row.*field = value;
        return nullptr;
    }
    const char* operator()(Seconds Row::*field) const {
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) ||
            std::signbit(value))
            return "seconds as a decimal number from 0 up, or an empty cell";
        row.*field = value;
        return nullptr;
    }
    const char* operator()(Ways ways) const {
        if (text == "full") {
            row.*ways.field = 0;
            return nullptr;
        }
        return (*this)(ways.field) != nullptr || row.*ways.field == std::uint64_t{0}
                   ? "a whole number from 1 up, \"full\" or an empty cell"
                   : nullptr;
    }
};

/// Where each known column stands in the file: an index into the cells, or nothing.
std::vector<std::optional<std::size_t>> places(const std::vector<std::string>& header,
                                               const Records& records) {
    std::vector<std::optional<std::size_t>> out;
    for (const Column& column : table) {
        const auto first = std::find(header.begin(), header.end(), column.name);
        const auto cell = static_cast<std::size_t>(first - header.begin());
        if (first == header.end()) {
            if (column.needed)
                records.refuse(records.line(), header.size(), column.name, "the end of the header",
                               fmt::format("a column \"{}\"", column.name));
            out.emplace_back();
            continue;
        }
        const auto again = std::find(first + 1, header.end(), column.name);
        if (again != header.end())
            records.refuse(records.line(), static_cast<std::size_t>(again - header.begin()), column.name,
                           "the column a second time", "each column once");
        out.emplace_back(cell);
    }
    return out;
}

}  // namespace

std::span<const Column> columns() {
    return table;
}

std::string to_csv(std::span<const Row> rows) {
    std::string out;
    for (const Column& column : table) fmt::format_to(std::back_inserter(out), "{},", column.name);
    out.back() = '\n';
    for (const Row& row : rows) {
        for (const Column& column : table) {
            out += std::visit(CellWriter{row}, column.field);
            out += ',';
        }
        out.back() = '\n';
    }
    return out;
}

std::vector<Row> from_csv(std::string_view text, std::string_view file) {
    Records records(text, file);
    std::vector<std::string> header, cells;
    if (!records.next(header)) throw trace::DataError(fmt::format("{}: empty, expected a header line", file));
    const auto place = places(header, records);

    std::vector<Row> rows;
    while (records.next(cells)) {
        if (cells.size() != header.size())
            records.refuse(records.line(), std::min(cells.size(), header.size()), "",
                           fmt::format("{} cells", cells.size()),
                           fmt::format("{} as in the header", header.size()));
        Row& row = rows.emplace_back();
        for (std::size_t c = 0; c < std::size(table); ++c) {
            if (!place[c]) continue;
            const std::string& cell = cells[*place[c]];
            const char* expected = nullptr;
            if (!cell.empty())
                expected = std::visit(CellReader{row, cell}, table[c].field);
            else if (table[c].name == "ordering")
                expected = "the name of an ordering";
            if (expected != nullptr)
                records.refuse(records.line(), *place[c], table[c].name, fmt::format("\"{}\"", shown(cell)),
                               expected);
        }
    }
    return rows;
}

void write_csv(const std::filesystem::path& path, std::span<const Row> rows) {
    trace::write_file(path, to_csv(rows));
}

std::vector<Row> read_csv(const std::filesystem::path& path) {
    return from_csv(trace::read_file(path), path.string());
}

}  // namespace regather::results
