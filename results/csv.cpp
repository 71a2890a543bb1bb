#include "results/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "results/table.h"
#include "trace/error.h"
#include "trace/file.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::results {
namespace {

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
        throw trace::DataError(
            fmt::format("{}: line {}, column {}{}: found {}, expected {}", file_, line, cell + 1,
                        name.empty() ? "" : fmt::format(" ({})", trace::shown(name)), found, expected));
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

/// Takes a number that fills the whole text.
template <class T>
std::errc parse(const std::string& text, T& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end != text.data() + text.size() ? std::errc::invalid_argument : error;
}

bool is_signed(Form form) {
    return form == Form::signed_real || form == Form::signed_seconds;
}

/// Each reads a cell that is not empty; null, or what was expected.
struct CellReader {
    Form form;
    const std::string& text;

    const char* operator()(std::string* field) const {
        *field = text;
        return nullptr;
    }
    const char* operator()(Count* field) const {
        if (form != Form::ways)
            return whole(*field, "a whole number below 2^64", "a whole number or an empty cell");
        if (text == "full") {
            *field = 0;
            return nullptr;
        }
        constexpr const char* expected = "a whole number from 1 up, \"full\" or an empty cell";
        return whole(*field, expected, expected) != nullptr || *field == std::uint64_t{0} ? expected
                                                                                          : nullptr;
    }
    const char* operator()(Signed* field) const {
        return whole(*field, "a whole number from -2^63 to below 2^63",
                     "a whole number, with a minus when below 0, or an empty cell");
    }
    const char* operator()(Flag* field) const {
        if (text != "0" && text != "1") return "1, 0 or an empty cell";
        *field = text == "1";
        return nullptr;
    }
    const char* operator()(Number* field) const {
        double value = 0;
        if (parse(text, value) != std::errc{} || !std::isfinite(value) ||
            (!is_signed(form) && (value < 0 || std::signbit(value)))) {
            switch (form) {
                case Form::seconds:
                    return "seconds as a decimal number from 0 up, or an empty cell";
                case Form::signed_seconds:
                    return "seconds as a decimal number, or an empty cell";
                case Form::signed_real:
                    return "a decimal number, or an empty cell";
                default:
                    return "a decimal number from 0 up, or an empty cell";
            }
        }
        *field = value;
        return nullptr;
    }

private:
    template <class T>
    const char* whole(std::optional<T>& field, const char* in_range, const char* expected) const {
        T value = 0;
        const std::errc error = parse(text, value);
        if (error == std::errc::result_out_of_range) return in_range;
        if (error != std::errc{}) return expected;
        field = value;
        return nullptr;
    }
};

struct CellWriter {
    Form form;

    std::string operator()(const std::string* field) const { return *field; }
    std::string operator()(const Count* field) const {
        if (form == Form::ways && *field == std::uint64_t{0}) return "full";
        return *field ? fmt::to_string(**field) : "";
    }
    std::string operator()(const Signed* field) const { return *field ? fmt::to_string(**field) : ""; }
    std::string operator()(const Flag* field) const { return !*field ? "" : **field ? "1" : "0"; }
    std::string operator()(const Number* field) const {
        if (!*field) return "";
        return form == Form::seconds || form == Form::signed_seconds ? fmt::format("{:.6f}", **field)
                                                                     : fmt::format("{}", **field);
    }
};

std::size_t place_of(std::span<const std::string> header, std::string_view name) {
    return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
}

/// Names of columns of `kind` that the header does not have.
std::vector<std::string_view> absent(const RowKind& kind, std::span<const std::string> header) {
    std::vector<std::string_view> out;
    for (const Column& column : kind.columns)
        if (place_of(header, column.name) == header.size()) out.push_back(column.name);
    return out;
}

/// The absent column that `name` is likely to mean: told from it by a letter or two.
std::optional<std::string_view> likely(std::string_view name, std::span<const std::string_view> absent) {
    constexpr std::size_t shortest = 4;
    if (name.size() < shortest || absent.empty()) return {};
    const auto nearest = trace::nearest_words(name, absent);
    return nearest.size() == 1 && trace::edit_distance(name, nearest[0]) <= 2 ? std::optional(nearest[0])
                                                                              : std::nullopt;
}

/// Where each column of `kind` stands in the file, if it does.
std::vector<std::optional<std::size_t>> places(const RowKind& kind, std::span<const std::string> header,
                                               const Records& records, std::vector<std::string>* unknown) {
    const std::vector<std::string_view> missing = absent(kind, header);
    for (std::size_t h = 0; h < header.size(); ++h) {
        const bool known = std::any_of(kind.columns.begin(), kind.columns.end(),
                                       [&](const Column& column) { return column.name == header[h]; });
        if (known && place_of(header, header[h]) != h)
            records.refuse(records.line(), h, header[h], "the column a second time", "each column once");
        if (known) continue;
        if (const auto meant = likely(header[h], missing))
            records.refuse(records.line(), h, header[h], "a column that is not known",
                           fmt::format("\"{}\"", *meant));
        if (unknown != nullptr) unknown->push_back(header[h]);
    }
    std::vector<std::optional<std::size_t>> out;
    for (const Column& column : kind.columns) {
        const std::size_t place = place_of(header, column.name);
        if (place == header.size() && column.needed)
            records.refuse(records.line(), header.size(), column.name, "the end of the header",
                           fmt::format("a column \"{}\"", column.name));
        out.push_back(place == header.size() ? std::nullopt : std::optional(place));
    }
    return out;
}

}  // namespace

std::string cell_text(const Column& column, const void* row) {
    // The accessors give what may be written to; here it is only read.
    return std::visit(CellWriter{column.form}, column.cell(const_cast<void*>(row)));
}

std::string to_csv(const RowKind& kind, const void* first, std::size_t count, std::size_t bytes) {
    std::string out;
    for (const Column& column : kind.columns) out += std::string(column.name) + ',';
    out.back() = '\n';
    for (std::size_t i = 0; i < count; ++i) {
        const void* row = static_cast<const std::byte*>(first) + i * bytes;
        for (const Column& column : kind.columns) out += csv_cell(cell_text(column, row)) + ',';
        out.back() = '\n';
    }
    return out;
}

void from_csv(const RowKind& kind, std::string_view text, std::string_view file,
              const std::function<void*()>& next, std::vector<std::string>* unknown) {
    Records records(text, file);
    std::vector<std::string> header, cells;
    if (!records.next(header))
        throw trace::DataError(fmt::format("{}: found nothing, expected a header line", file));
    const auto place = places(kind, header, records, unknown);
    while (records.next(cells)) {
        if (cells.size() != header.size())
            records.refuse(records.line(), std::min(cells.size(), header.size()), "",
                           fmt::format("{} cells", cells.size()),
                           fmt::format("{} as in the header", header.size()));
        void* row = next();
        for (std::size_t c = 0; c < place.size(); ++c) {
            if (!place[c]) continue;
            const Column& column = kind.columns[c];
            const std::string& cell = cells[*place[c]];
            const char* expected = nullptr;
            if (!cell.empty())
                expected = std::visit(CellReader{column.form, cell}, column.cell(row));
            else if (column.form == Form::name)
                expected = "a name";
            if (expected != nullptr)
                records.refuse(records.line(), *place[c], column.name, trace::in_quotes(cell), expected);
        }
    }
}

std::vector<std::string> header_of(std::string_view text, std::string_view file) {
    Records records(text, file);
    std::vector<std::string> header;
    if (!records.next(header))
        throw trace::DataError(fmt::format("{}: found nothing, expected a header line", file));
    return header;
}

void write_csv(const std::filesystem::path& path, std::string_view csv) {
    trace::write_whole(path, csv);
}

std::string read_csv_text(const std::filesystem::path& path) {
    return trace::read_file(path);
}

}  // namespace regather::results
